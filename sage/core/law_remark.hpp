// Optional interface of laws with something to say that no user has to change: a note, once for each material.
#pragma once

#include <string>

namespace sage {

class LawRemark {
 public:
  // A clause; caution() is for parameters that are rarely meant.
  virtual std::string remark() const = 0;

 protected:
  ~LawRemark() = default;
};

// Of any law: empty where it has none.
template <class AnyLaw>
std::string remark_of(const AnyLaw& law) {
  const auto* const remark = dynamic_cast<const LawRemark*>(&law);
  return remark != nullptr ? remark->remark() : std::string();
}

}  // namespace sage
