// Lazy, thread-safe computation of a value.
#pragma once

#include <mutex>
#include <optional>

namespace triglyph {

// A value that is computed on first use. Safe to use from many threads: the first one computes, the
// others wait.
template <typename T>
class Once {
 public:
  // Returns the value, computed by `make` if this is the first call. If `make` throws, the next
  // call tries again.
  template <typename Make>
  [[nodiscard]] const T& get(const Make& make) const {
    std::call_once(made_, [&] { value_.emplace(make()); });
    return *value_;
  }

 private:
  mutable std::once_flag made_;
  mutable std::optional<T> value_;
};

}  // namespace triglyph
