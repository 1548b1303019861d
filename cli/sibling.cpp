#include "cli/sibling.h"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <sstream>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/base/error.h"
#include "manifests/json_line.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "triglyph-render";

bool is_executable(const fs::path& path) {
  return access(path.c_str(), X_OK) == 0;
}

// Returns the arguments as exec takes them; the strings must outlive them.
std::vector<char*> argument_vector(const fs::path& program, const std::vector<std::string>& rest) {
  std::vector<char*> all{const_cast<char*>(program.c_str())};
  for (const std::string& argument : rest) all.push_back(const_cast<char*>(argument.c_str()));
  all.push_back(nullptr);
  return all;
}

[[noreturn]] void fail_to_start(const fs::path& program) {
  throw Error(ErrorCode::Usage, program, "", system_reason(errno));
}

}  // namespace

fs::path find_renderer() {
  std::error_code ignored;
  const fs::path self = fs::read_symlink("/proc/self/exe", ignored);
  fs::path beside = self.parent_path() / kName;
  if (!self.empty() && is_executable(beside)) return beside;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    fs::path candidate = fs::path(folder) / kName;
    if (!folder.empty() && is_executable(candidate)) return candidate;
  }
  throw Error(ErrorCode::Usage, {}, "",
              "pictures need triglyph-render, which is neither beside triglyph nor in PATH");
}

void exec_renderer(const std::vector<std::string>& arguments) {
  const fs::path program = find_renderer();
  execv(program.c_str(), argument_vector(program, arguments).data());
  fail_to_start(program);
}

RendererProcess start_renderer(const std::vector<std::string>& arguments, bool dies_with_thread) {
  const fs::path program = find_renderer();
  std::vector<char*> all = argument_vector(program, arguments);
  int jobs[2];
  int answers[2];
  if (pipe2(jobs, O_CLOEXEC) != 0) fail_to_start(program);
  if (pipe2(answers, O_CLOEXEC) != 0) {
    close(jobs[0]);
    close(jobs[1]);
    fail_to_start(program);
  }
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) {
    if (dies_with_thread) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) _exit(1);
    }
    // the run handles interrupts, and then stops its renderer
    std::signal(SIGINT, SIG_IGN);
    std::signal(SIGUSR1, SIG_IGN);  // a question about the run is none to its renderers
    dup2(jobs[0], STDIN_FILENO);
    dup2(answers[1], STDOUT_FILENO);
    execv(program.c_str(), all.data());
    _exit(127);
  }
  close(jobs[0]);
  close(answers[1]);
  if (child < 0) {
    close(jobs[1]);
    close(answers[0]);
    fail_to_start(program);
  }
  std::signal(SIGPIPE, SIG_IGN);
  return {child, jobs[1], answers[0]};
}

RenderBatch::RenderBatch(const std::vector<std::string>& arguments)
    : process_(start_renderer(arguments, false)) {}

RenderBatch::~RenderBatch() {
  (void)finish();
}

void RenderBatch::draw(const fs::path& original, const fs::path& marked, const fs::path& out) {
  nlohmann::ordered_json job;
  put_path(job, "original", original);
  put_path(job, "marked", marked);
  put_path(job, "out", out);
  const std::string line = to_line(job);
  std::size_t sent = 0;
  while (sent < line.size()) {
    const ssize_t count = write(process_.jobs, line.data() + sent, line.size() - sent);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return;
    sent += static_cast<std::size_t>(count);
  }
}

void RenderBatch::stop() const {
  if (process_.id >= 0) kill(process_.id, SIGTERM);
}

std::optional<std::size_t> RenderBatch::finish() {
  if (process_.id < 0) return 0;
  close(process_.jobs);
  std::string answer;
  for (char letter = 0;;) {
    const ssize_t count = read(process_.answers, &letter, 1);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    answer += letter;
  }
  close(process_.answers);
  int status = 0;
  while (waitpid(process_.id, &status, 0) < 0 && errno == EINTR) {
  }
  process_.id = -1;
  std::size_t failed = 0;
  const char* end = answer.data() + answer.size();
  const bool is_answer = std::from_chars(answer.data(), end, failed).ec == std::errc();
  return WIFEXITED(status) && is_answer ? std::optional(failed) : std::nullopt;
}

}  // namespace triglyph
