// Pictures of a run, drawn by processes triglyph-render that answer one request after another: a
// picture that kills or hangs its renderer costs no other.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "cli/sibling.h"
#include "manifests/file_runs.h"

namespace triglyph {

// A process triglyph-render --batch --answer. It dies with the thread that started it.
class Renderer {
 public:
  // Starts the process and waits until it is ready. Throws Error Usage if it cannot be started or
  // does not take the arguments, of which it has said why.
  explicit Renderer(const std::vector<std::string>& arguments);

  // Ends the process: it may finish its picture within a second, and is killed then.
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Draws a picture of the two meshes with so many threads, and returns why there is none. Throws
  // Stopped as stop_point() does. Kills this process if the kernel killed the renderer, which says
  // nothing of the picture before it happens again: the supervisor will try it alone.
  [[nodiscard]] std::optional<FileFailure> draw(const MeshPair& pair,
                                                const std::filesystem::path& out, int threads);

  // Returns whether the process can take another request.
  [[nodiscard]] bool is_alive() const { return process_.id >= 0; }

 private:
  [[nodiscard]] bool send(const std::string& line) const;
  [[nodiscard]] std::optional<std::string> receive();
  [[nodiscard]] FileFailure failure_of_death(const std::filesystem::path& original);
  int end();

  RendererProcess process_;
  std::string received_;  // of the next answer
};

// Renderers for the threads of a run, each started when it is first needed. One of them has as many
// threads as the run has for each picture under way, so that many small pictures are drawn side by
// side and a large one that is alone gets all.
class RendererPool {
 public:
  // Starts a renderer, whose errors it throws. `threads`: of the run, 0 for all.
  RendererPool(std::vector<std::string> arguments, int threads);

  // See Renderer::draw(). May be called by any thread. A renderer that died is not used again.
  [[nodiscard]] std::optional<FileFailure> draw(const MeshPair& pair,
                                                const std::filesystem::path& out);

 private:
  [[nodiscard]] std::unique_ptr<Renderer> take();
  void give(std::unique_ptr<Renderer> renderer);

  std::vector<std::string> arguments_;
  int threads_;
  std::atomic<int> under_way_{0};
  std::mutex mutex_;
  std::vector<std::unique_ptr<Renderer>> idle_;
};

}  // namespace triglyph
