// Optional interface of laws that something outside the program computes.
#pragma once

namespace sage {

class CallsInOrder {
 public:
  // Its calls must come one after the other, in the order of the elements, since what computes it may remember them.  Laws
  // without this interface may be called by several threads at once.
  virtual bool needs_order() const = 0;

 protected:
  ~CallsInOrder() = default;
};

// Of any law.
template <class AnyLaw>
bool needs_order(const AnyLaw& law) {
  const auto* const in_order = dynamic_cast<const CallsInOrder*>(&law);
  return in_order != nullptr && in_order->needs_order();
}

}  // namespace sage
