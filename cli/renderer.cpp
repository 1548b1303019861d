#include "cli/renderer.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/stop.h"
#include "manifests/json_line.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// How long a renderer may take to end, in milliseconds: less than a worker may after an interrupt.
constexpr int kGrace = 1000;

// How often a thread that waits for a picture looks whether the run is interrupted, in
// milliseconds.
constexpr int kTick = 50;

// Waits until there are bytes in the pipe or its writer has closed it, and returns whether it is
// so.
bool wait_for_bytes(int pipe, int milliseconds) {
  pollfd one{.fd = pipe, .events = POLLIN, .revents = 0};
  return poll(&one, 1, milliseconds) > 0;
}

// Waits until the writer of the pipe has closed it.
void wait_for_end(int pipe, int milliseconds) {
  pollfd one{.fd = pipe, .events = 0, .revents = 0};
  while (poll(&one, 1, milliseconds) < 0 && errno == EINTR) {
  }
}

std::string cause_of(int status) {
  if (!WIFSIGNALED(status)) {
    return "ended the renderer with exit code " + std::to_string(WEXITSTATUS(status));
  }
  const int signal = WTERMSIG(status);
  return "killed the renderer by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
}

}  // namespace

Renderer::Renderer(const std::vector<std::string>& arguments) {
  std::vector<std::string> all = {"--batch", "--answer"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  process_ = start_renderer(all, true);
  try {
    if (receive()) return;
  } catch (...) {  // Stopped
    end();
    throw;
  }
  const int status = end();
  const bool refused = WIFEXITED(status);
  throw Error(ErrorCode::Usage, {}, "",
              refused ? "triglyph-render does not take these arguments"
                      : "triglyph-render cannot be started: the arguments " + cause_of(status));
}

Renderer::~Renderer() {
  end();
}

std::optional<FileFailure> Renderer::draw(const MeshPair& pair, const fs::path& out, int threads) {
  nlohmann::ordered_json job;
  put_path(job, "original", pair.original);
  put_path(job, "marked", pair.marked);
  put_path(job, "out", out);
  job["threads"] = threads;
  if (!send(to_line(job))) return failure_of_death(pair.original);
  const std::optional<std::string> line = receive();
  if (!line) return failure_of_death(pair.original);
  try {
    const nlohmann::ordered_json answer = parse_json_line(*line);
    if (answer.empty()) return std::nullopt;
    const auto status = file_status(answer.at("status").get<std::string>());
    return FileFailure{status.value_or(FileStatus::Failed), answer.at("error").get<std::string>()};
  } catch (const std::exception&) {  // what follows cannot be trusted either
    end();
    return FileFailure{FileStatus::Crashed,
                       pair.original.string() + ": the renderer's answer makes no sense"};
  }
}

bool Renderer::send(const std::string& line) const {
  std::size_t sent = 0;
  while (sent < line.size()) {
    const ssize_t count = write(process_.jobs, line.data() + sent, line.size() - sent);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

// Returns the next line, or nothing if the process ended. It has one request at a time, so nothing
// follows its answer.
std::optional<std::string> Renderer::receive() {
  received_.clear();
  while (received_.empty() || received_.back() != '\n') {
    stop_point();
    if (!wait_for_bytes(process_.answers, kTick)) continue;
    char bytes[512];
    const ssize_t count = read(process_.answers, bytes, sizeof bytes);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::nullopt;
    received_.append(bytes, static_cast<std::size_t>(count));
  }
  return received_;
}

FileFailure Renderer::failure_of_death(const fs::path& original) {
  const int status = end();
  stop_point();
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) kill(getpid(), SIGKILL);
  return {FileStatus::Crashed, original.string() + ": " + cause_of(status)};
}

// Ends the process and returns its status, as waitpid() does.
int Renderer::end() {
  if (process_.id < 0) return 0;
  close(process_.jobs);
  wait_for_end(process_.answers, kGrace);
  close(process_.answers);
  kill(process_.id, SIGKILL);  // does nothing to one that has ended
  int status = 0;
  while (waitpid(process_.id, &status, 0) < 0 && errno == EINTR) {
  }
  process_.id = -1;
  return status;
}

RendererPool::RendererPool(std::vector<std::string> arguments, int threads)
    : arguments_(std::move(arguments)), threads_(thread_count(threads)) {
  idle_.push_back(std::make_unique<Renderer>(arguments_));
}

std::optional<FileFailure> RendererPool::draw(const MeshPair& pair, const fs::path& out) {
  std::unique_ptr<Renderer> renderer = take();
  const int share = std::max(1, threads_ / ++under_way_);
  std::optional<FileFailure> failure;
  try {
    failure = renderer->draw(pair, out, share);
  } catch (...) {
    --under_way_;
    throw;
  }
  --under_way_;
  if (renderer->is_alive()) give(std::move(renderer));
  return failure;
}

std::unique_ptr<Renderer> RendererPool::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      std::unique_ptr<Renderer> renderer = std::move(idle_.back());
      idle_.pop_back();
      return renderer;
    }
  }
  return std::make_unique<Renderer>(arguments_);
}

void RendererPool::give(std::unique_ptr<Renderer> renderer) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(renderer));
}

}  // namespace triglyph
