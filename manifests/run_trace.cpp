#include "manifests/run_trace.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <new>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/base/error.h"

namespace triglyph {
namespace {

// How a trace begins, by which it is known from other files.
constexpr std::string_view kTraceBegin = R"([
{"name":"process_name","ph":"M",)";

// How often the resident memory is read, in microseconds: reading takes about 10.
constexpr std::int64_t kMemoryPeriod = 20000;

std::string in_quotes(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

template <typename... Values>
std::string event_text(const char* pattern, Values... values) {
  std::array<char, 192> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

std::string ids() {
  return event_text(R"("pid":%d,"tid":%d)", getpid(), gettid());
}

std::string list_of(std::initializer_list<TraceValue> values) {
  std::string text;
  for (const auto& [name, value] : values) {
    if (!text.empty()) text += ',';
    text += in_quotes(name);
    text += event_text(":%.12g", value);
  }
  return text;
}

// Returns whether the file may be replaced: it is not there, is empty, no plain file, or a trace.
bool may_become_trace(const std::filesystem::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode) || status.st_size == 0) {
    return true;
  }
  std::string begin(kTraceBegin.size(), '\0');
  std::ifstream(path, std::ios::binary).read(begin.data(), static_cast<long>(begin.size()));
  return begin == kTraceBegin;
}

// The trace that this thread was last introduced to, by its beginning, and as part of which
// process.
struct TracedThread {
  TraceTime trace;
  pid_t process = 0;
};
thread_local TracedThread traced_thread;

}  // namespace

RunTrace::RunTrace(const std::filesystem::path& path)
    : path_(path), start_(std::chrono::steady_clock::now()) {
  if (!may_become_trace(path)) {
    throw Error(ErrorCode::Unwritable, path, "", "is there already, and no trace");
  }
  void* memory =
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  shared_ = new (memory) Shared;
  descriptor_ = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    const int error = errno;
    munmap(shared_, sizeof(Shared));
    throw Error(ErrorCode::Unwritable, path, "", system_reason(error));
  }
  write(std::string(kTraceBegin) + ids() + R"(,"args":{"name":"triglyph"}})");
}

RunTrace::~RunTrace() {
  close(descriptor_);
  munmap(shared_, sizeof(Shared));
}

double RunTrace::microseconds(TraceTime time) const {
  return std::chrono::duration<double, std::micro>(time - start_).count();
}

// One call for the whole line, so that lines of several threads and processes do not mix.
void RunTrace::write(const std::string& event, std::string_view ending) const {
  if (shared_->error != 0) return;  // what follows a gap would be no JSON
  const std::string line = event + std::string(ending);
  ssize_t written = 0;
  do {
    written = ::write(descriptor_, line.data(), line.size());
  } while (written < 0 && errno == EINTR);
  if (written != static_cast<ssize_t>(line.size())) shared_->error = written < 0 ? errno : ENOSPC;
}

void RunTrace::name_process(std::string_view name) const {
  write(R"({"name":"process_name","ph":"M",)" + ids() + R"(,"args":{"name":)" + in_quotes(name) +
        "}}");
}

void RunTrace::introduce_thread() const {
  const pid_t process = getpid();
  if (traced_thread.trace == start_ && traced_thread.process == process) return;
  traced_thread = {start_, process};
  const std::string name = gettid() == process ? "main" : "thread " + std::to_string(gettid());
  write(R"({"name":"thread_name","ph":"M",)" + ids() + R"(,"args":{"name":)" + in_quotes(name) +
        "}}");
}

void RunTrace::span(std::string_view name, std::string_view file, TraceTime start, TraceTime end,
                    std::initializer_list<TraceValue> values) const {
  introduce_thread();
  const double begin = microseconds(start);
  std::string event =
      R"({"name":)" + in_quotes(name) + R"(,"ph":"X",)" + ids() +
      event_text(R"(,"ts":%.3f,"dur":%.3f,"args":{"file":)", begin, microseconds(end) - begin) +
      in_quotes(file);
  if (values.size() > 0) event += ',';
  event += list_of(values);
  write(event + "}}");
}

void RunTrace::instant(std::string_view name, std::string_view detail) const {
  introduce_thread();
  write(R"({"name":)" + in_quotes(name) + R"(,"ph":"i","s":"p",)" + ids() +
        event_text(R"(,"ts":%.3f,"args":{"detail":)",
                   microseconds(std::chrono::steady_clock::now())) +
        in_quotes(detail) + "}}");
}

void RunTrace::count(std::string_view counter, std::initializer_list<TraceValue> values) const {
  write(R"({"name":)" + in_quotes(counter) + R"(,"ph":"C",)" + ids() +
        event_text(R"(,"ts":%.3f,"args":{)", microseconds(std::chrono::steady_clock::now())) +
        list_of(values) + "}}");
}

void RunTrace::count_memory() const {
  const auto now = static_cast<std::int64_t>(microseconds(std::chrono::steady_clock::now()));
  std::int64_t last = shared_->memory_at;
  if (last != 0 && now - last < kMemoryPeriod) return;
  if (!shared_->memory_at.compare_exchange_strong(last, now)) return;  // another thread does it
  long pages = 0;
  std::ifstream statistics("/proc/self/statm");
  if (statistics >> pages >> pages) {
    count("resident memory", {{"bytes", static_cast<double>(pages * sysconf(_SC_PAGESIZE))}});
  }
}

void RunTrace::finish() {
  write(R"({"name":"run","ph":"i","s":"g",)" + ids() +
            event_text(R"(,"ts":%.3f,"args":{"detail":"ended"}})",
                       microseconds(std::chrono::steady_clock::now())),
        "\n]\n");
  if (shared_->error != 0) {
    throw Error(ErrorCode::Unwritable, path_, "", system_reason(shared_->error));
  }
}

TraceSpan::TraceSpan(const RunTrace* trace, std::string_view name, std::string_view file)
    : trace_(trace), name_(name), file_(file) {
  if (trace_ != nullptr) start_ = std::chrono::steady_clock::now();
}

void TraceSpan::end() {
  if (trace_ == nullptr) return;
  trace_->span(name_, file_, start_, std::chrono::steady_clock::now());
  trace_ = nullptr;
}

}  // namespace triglyph
