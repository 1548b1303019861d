// A value worked out when it is first asked for.
#pragma once

#include <mutex>
#include <optional>

namespace triglyph {

// Safe to ask from many threads; the first one makes the value, the others wait for it.
template <typename T>
class Once {
 public:
  // `make` returns a T. If it throws, the next caller tries again.
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
