// A trace of a run: what every thread did with every file, and when, as Perfetto and
// chrome://tracing show it.
//
// The file is in the JSON array format of the Trace Event Format, an event a line. Every event is
// appended by one system call as soon as it is over, so that a process that is killed takes none
// with it; the array then lacks its end, which the format allows and viewers expect.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace triglyph {

// Times of a trace are those of the engine's stages.
using TraceTime = std::chrono::steady_clock::time_point;

// A number that an event carries, by its name.
using TraceValue = std::pair<std::string_view, double>;

// Members may be called from any thread, and from processes that were forked from the one that made
// the object, all of which write into the same file. They do not throw: see finish().
class RunTrace {
 public:
  // Creates the file, or replaces an earlier trace. Throws Error Unwritable if it cannot be
  // written, also where a file of that name is no trace.
  explicit RunTrace(const std::filesystem::path& path);
  ~RunTrace();
  RunTrace(const RunTrace&) = delete;
  RunTrace& operator=(const RunTrace&) = delete;

  // Gives the process that calls a name. To be called first in a forked process.
  void name_process(std::string_view name) const;

  // Something that this thread did with a file.
  void span(std::string_view name, std::string_view file, TraceTime start, TraceTime end,
            std::initializer_list<TraceValue> values = {}) const;

  // Something that happened to the whole process.
  void instant(std::string_view name, std::string_view detail) const;

  // The values of a counter from now on.
  void count(std::string_view counter, std::initializer_list<TraceValue> values) const;

  // The resident memory of the process, at most fifty times a second.
  void count_memory() const;

  // Ends the array. To be called once, by the process that made the object, after all others have
  // ended. Throws Error Unwritable if an event could not be written.
  void finish();

 private:
  struct Shared {                            // by all processes
    std::atomic<int> error{0};               // errno of the first event that could not be written
    std::atomic<std::int64_t> memory_at{0};  // when count_memory() last wrote, microseconds
  };

  [[nodiscard]] double microseconds(TraceTime time) const;
  void write(const std::string& event, std::string_view ending = ",\n") const;
  void introduce_thread() const;

  std::filesystem::path path_;
  TraceTime start_;
  int descriptor_ = -1;
  Shared* shared_ = nullptr;
};

// A span that lasts as long as the object. Without a trace it does nothing and reads no clock.
class TraceSpan {
 public:
  // What the names refer to must outlive the object.
  TraceSpan(const RunTrace* trace, std::string_view name, std::string_view file);
  ~TraceSpan() { end(); }
  TraceSpan(const TraceSpan&) = delete;
  TraceSpan& operator=(const TraceSpan&) = delete;
  void end();

 private:
  const RunTrace* trace_;
  std::string_view name_;
  std::string_view file_;
  TraceTime start_;
};

}  // namespace triglyph
