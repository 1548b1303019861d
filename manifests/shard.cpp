#include "manifests/shard.h"

#include <algorithm>
#include <cstdio>

#include "engine/base/error.h"

namespace triglyph {
namespace {

// What a mesh of no size costs, in bytes: many small meshes take longer than one that is as large
// as all of them.
constexpr std::uint64_t kBytesOfAJob = 16 << 10;

std::uint64_t weight_of(const Job& job) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(job.mesh, error);
  return kBytesOfAJob + (error ? 0 : static_cast<std::uint64_t>(bytes));
}

}  // namespace

Shard Shard::parsed(const std::string& text, std::string_view option) {
  Shard shard;
  char after = 0;
  const bool has_digit_first = !text.empty() && text[0] >= '0' && text[0] <= '9';
  const int read = std::sscanf(text.c_str(), "%6u/%6u%c", &shard.number, &shard.count, &after);
  if (!has_digit_first || read != 2 || shard.number < 1 || shard.number > shard.count) {
    std::string message(option);
    message.append(" is a part of so many, such as 3/7, not ").append(text);
    throw Error(ErrorCode::Usage, {}, "", message);
  }
  return shard;
}

std::string Shard::text() const {
  std::string text = std::to_string(number);
  return text.append("/").append(std::to_string(count));
}

std::filesystem::path name_for(const Shard& shard, const std::filesystem::path& path) {
  if (shard.is_whole()) return path;
  std::filesystem::path name = path.stem();
  name += ".shard-";
  name += std::to_string(shard.number);
  name += "-of-";
  name += std::to_string(shard.count);
  name += path.extension();
  return path.parent_path() / name;
}

ShardPlan plan_shards(JobSource& jobs) {
  ShardPlan plan;
  while (const std::optional<Job> job = jobs.next()) {
    plan.weight += weight_of(*job);
    ++plan.jobs;
  }
  return plan;
}

ShardSource::ShardSource(std::unique_ptr<JobSource> jobs, const Shard& shard, const ShardPlan& plan)
    : jobs_(std::move(jobs)), shard_(shard), plan_(plan) {}

std::optional<Job> ShardSource::next() {
  while (std::optional<Job> job = jobs_->next()) {
    const std::uint64_t weight = weight_of(*job);
    if (job->mesh != mesh_) {
      // by its middle, so that no shard is left out for a mesh that reaches over it
      const long double middle = static_cast<long double>(before_) + weight / 2.0L;
      const long double share =
          middle / static_cast<long double>(std::max<std::uint64_t>(1, plan_.weight));
      last_ = std::min(static_cast<std::uint32_t>(share * shard_.count), shard_.count - 1);
      mesh_ = job->mesh;
    }
    before_ += weight;
    if (last_ + 1 != shard_.number) continue;
    job->index = index_++;
    return job;
  }
  return std::nullopt;
}

}  // namespace triglyph
