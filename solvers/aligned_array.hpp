// Storage on a cache-line boundary, not initialised: large factors are written before they are read.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

#include "sage/platform/large_pages.hpp"

namespace sage {

class AlignedArray {
 public:
  AlignedArray() = default;
  // Throws std::bad_alloc.
  explicit AlignedArray(std::size_t size) : size_(size) {
    data_.reset(static_cast<double*>(allocate_block(size * sizeof(double))));
    if (!data_) throw std::bad_alloc();
  }
  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  std::size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(double* p) const { std::free(p); }
  };
  std::unique_ptr<double[], Free> data_;
  std::size_t size_ = 0;
};

}  // namespace sage
