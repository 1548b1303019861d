#include "manifests/share.h"

#include <chrono>
#include <cstdlib>
#include <string_view>
#include <thread>

namespace triglyph {

BoardEntry::BoardEntry(const WorkOrder* order, std::size_t index, std::string_view name)
    : board_(order == nullptr ? nullptr : order->board), index_(index) {
  if (board_ != nullptr) board_->begin(index, name);
}

BoardEntry::~BoardEntry() {
  if (board_ != nullptr) board_->end(index_);
}

bool Share::leaves_out(std::size_t index) const {
  if (order_ == nullptr) return false;
  return order_->only ? *order_->only != index : index < order_->board->delivered;
}

void Share::count_delivered(std::size_t index) const {
  if (order_ != nullptr && delivers()) order_->board->delivered = index + 1;
}

const Casualty* Share::casualty(std::size_t index) const {
  return order_ == nullptr ? nullptr : order_->casualty(index);
}

FileStatus status_of(const Casualty& casualty) {
  return casualty.is_slow ? FileStatus::TooSlow : FileStatus::Crashed;
}

FlowOptions flow_options(const RunContext& context) {
  FlowOptions options = context.flow;
  if (context.order != nullptr && context.order->one_at_a_time) options.memory_bytes = 0;
  return options;
}

std::uint64_t memory_of(const std::filesystem::path& path, MeshWork work) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  return estimate_memory(error ? 0 : bytes, path, work);
}

void fail_if_asked(const std::filesystem::path& path) {
  const char* fault = std::getenv("TRIGLYPH_FAULT");
  if (fault == nullptr) return;
  const std::string_view text(fault);
  const std::string name = path.filename().string();
  if (text == "crash " + name) std::abort();
  while (text == "hang " + name) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

}  // namespace triglyph
