// Laws of bars that stand for one every so often.
#pragma once

namespace sage {

class SpacedMembers {
 public:
  virtual ~SpacedMembers() = default;
  // Distance from one bar to the next: forces of the law are those of one bar divided by it.
  virtual double spacing() const = 0;
};

}  // namespace sage
