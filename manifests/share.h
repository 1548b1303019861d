// What all runs do with the order of their supervisor. For the files that implement runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "engine/marking/mark_file.h"
#include "manifests/run_context.h"

namespace triglyph {

// Tells the supervisor which item this thread processes, while the object lives.
class BoardEntry {
 public:
  BoardEntry(const WorkOrder* order, std::size_t index, std::string_view name);
  ~BoardEntry();
  BoardEntry(const BoardEntry&) = delete;
  BoardEntry& operator=(const BoardEntry&) = delete;

 private:
  RunBoard* board_;
  std::size_t index_;
};

// The part of a run that a worker is to do.
class Share {
 public:
  explicit Share(const RunContext& context) : order_(context.order) {}

  // An earlier worker delivered the item, or a suspect is to be tried alone and this is another.
  [[nodiscard]] bool leaves_out(std::size_t index) const;
  [[nodiscard]] bool delivers() const { return order_ == nullptr || !order_->only; }
  void count_delivered(std::size_t index) const;
  // What became of an item that an earlier worker died of, or null.
  [[nodiscard]] const Casualty* casualty(std::size_t index) const;

 private:
  const WorkOrder* order_;
};

[[nodiscard]] FileStatus status_of(const Casualty& casualty);

// Returns the options of the flow: one item at a time if the order says so.
[[nodiscard]] FlowOptions flow_options(const RunContext& context);

// Returns the estimate of the memory that a file takes; see estimate_memory().
[[nodiscard]] std::uint64_t memory_of(const std::filesystem::path& path, MeshWork work);

// For tests of the supervision: TRIGLYPH_FAULT="crash NAME" or "hang NAME" lets the process die or
// hang when it processes the file of that name.
void fail_if_asked(const std::filesystem::path& path);

}  // namespace triglyph
