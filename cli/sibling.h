// The executable that draws pictures. It is one of its own because its libraries take 0.2 s to
// load.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace triglyph {

// triglyph-render, beside the running executable or else in PATH's directories. Throws Error Usage
// if it is in neither.
[[nodiscard]] std::filesystem::path find_renderer();

// Becomes triglyph-render with these arguments; does not return. Throws Error Usage if it cannot be
// started.
[[noreturn]] void become_renderer(const std::vector<std::string>& arguments);

// triglyph-render --batch in a process of its own: pictures are drawn while the run goes on.
class RenderBatch {
 public:
  // Throws Error Usage if it cannot be started.
  explicit RenderBatch(const std::vector<std::string>& arguments);
  ~RenderBatch();
  RenderBatch(const RenderBatch&) = delete;
  RenderBatch& operator=(const RenderBatch&) = delete;

  // Has a picture drawn of the two meshes. Waits if the renderer is far behind. What comes after
  // the renderer died is lost; finish() then says so.
  void draw(const std::filesystem::path& original, const std::filesystem::path& marked,
            const std::filesystem::path& out);

  // Only the picture that is being drawn will still be.
  void stop() const;

  // Waits for the last picture. Were all drawn?
  [[nodiscard]] bool finish();

 private:
  int pipe_ = -1;
  int process_ = -1;
};

}  // namespace triglyph
