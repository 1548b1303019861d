// Access to triglyph-render, the executable that draws pictures. It is separate because its
// libraries take 0.2 s to load.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace triglyph {

// Returns the path of triglyph-render, beside the running executable or else in a directory of
// PATH. Throws Error Usage if it is in neither.
[[nodiscard]] std::filesystem::path find_renderer();

// Replaces this process by triglyph-render with these arguments. Throws Error Usage if it cannot be
// started.
[[noreturn]] void exec_renderer(const std::vector<std::string>& arguments);

// A child process triglyph-render, with pipes to its standard input and from its standard output.
struct RendererProcess {
  int id = -1;
  int jobs = -1;
  int answers = -1;
};

// Starts triglyph-render, deaf to SIGINT. It is killed when the thread that started it ends, if
// `dies_with_thread`. SIGPIPE is ignored from then on in this process too, so that writing to a
// renderer that died is an error. Throws Error Usage if it cannot be started.
[[nodiscard]] RendererProcess start_renderer(const std::vector<std::string>& arguments,
                                             bool dies_with_thread);

// A child process triglyph-render --batch, which draws pictures while the run continues.
class RenderBatch {
 public:
  // Throws Error Usage if it cannot be started.
  explicit RenderBatch(const std::vector<std::string>& arguments);
  ~RenderBatch();
  RenderBatch(const RenderBatch&) = delete;
  RenderBatch& operator=(const RenderBatch&) = delete;

  // Queues a picture of the two meshes. Blocks if the renderer is far behind. If the renderer died,
  // the picture is lost and finish() returns nothing.
  void draw(const std::filesystem::path& original, const std::filesystem::path& marked,
            const std::filesystem::path& out);

  // Lets the renderer finish the current picture only.
  void stop() const;

  // Waits for the last picture. Returns the number of pictures that could not be drawn; nothing if
  // the renderer ended before the last one.
  [[nodiscard]] std::optional<std::size_t> finish();

 private:
  RendererProcess process_;
};

}  // namespace triglyph
