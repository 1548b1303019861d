// Stopping long computations from outside: a flag that every long loop looks at.
#pragma once

#include <atomic>
#include <exception>

namespace triglyph {

// Thrown by stop_point() once the flag is set; no error of the mesh or of the program.
class Stopped final : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override;
};

namespace internal {

// The flag of the innermost StopScope; null: none. One for the whole process, since the threads
// that work for a caller are not known to it.
inline std::atomic<const std::atomic<bool>*> stop_flag = nullptr;

[[noreturn]] void throw_stopped();

}  // namespace internal

// Makes stop_point() look at a flag as long as the scope lives; afterwards it looks at what it did
// before. Scopes nest, and do not overlap otherwise. All work that was started within the scope
// must have ended before it does, and the flag must outlive it.
class StopScope {
 public:
  explicit StopScope(const std::atomic<bool>& flag)
      : before_(internal::stop_flag.exchange(&flag)) {}
  ~StopScope() { internal::stop_flag = before_; }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  const std::atomic<bool>* before_;
};

// Throws Stopped if the flag is set. Costs two loads, so a loop whose turns take longer than some
// ten nanoseconds can call it in each. Not to be called where an exception must not leave: in
// destructors and between changes that belong together.
inline void stop_point() {
  const std::atomic<bool>* flag = internal::stop_flag.load(std::memory_order_relaxed);
  if (flag != nullptr && flag->load(std::memory_order_relaxed)) internal::throw_stopped();
}

}  // namespace triglyph
