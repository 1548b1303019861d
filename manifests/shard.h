// Parts of a run, each for a process or machine of its own, and together the whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "manifests/manifest.h"

namespace triglyph {

// Part `number` of `count`, from 1.
struct Shard {
  std::uint32_t number = 1;
  std::uint32_t count = 1;

  // Parses "3/7". Throws Error Usage, naming the option, for anything that is no part.
  [[nodiscard]] static Shard parsed(const std::string& text, std::string_view option);
  [[nodiscard]] std::string text() const;
  [[nodiscard]] bool is_whole() const { return count == 1; }
};

// Returns the name that a file of the whole run has for one shard: "run.shard-3-of-7.jsonl" for
// "run.jsonl". That of the whole is unchanged.
[[nodiscard]] std::filesystem::path name_for(const Shard& shard, const std::filesystem::path& path);

// What all shards of a plan must agree on.
struct ShardPlan {
  std::uint64_t weight = 0;  // of all jobs
  std::uint64_t jobs = 0;
};

// Returns the plan of all jobs of a run. A job weighs as many bytes as its mesh, and a little more.
// O(jobs), without keeping them.
[[nodiscard]] ShardPlan plan_shards(JobSource& jobs);

// The jobs of one shard, numbered from 0, in the order of the whole run, in which each keeps its
// place. Shards are disjoint and together all jobs; each has about the same weight, but for the
// heaviest mesh. Copies of one mesh stay together. Depends on the jobs and on the sizes of their
// meshes alone.
class ShardSource final : public JobSource {
 public:
  // `jobs` are those of the plan.
  ShardSource(std::unique_ptr<JobSource> jobs, const Shard& shard, const ShardPlan& plan);
  [[nodiscard]] std::optional<Job> next() override;

 private:
  std::unique_ptr<JobSource> jobs_;
  Shard shard_;
  ShardPlan plan_;
  std::uint64_t before_ = 0;  // weight of the jobs so far
  std::uint32_t last_ = 0;    // the shard of the last job
  std::filesystem::path mesh_;
  std::size_t index_ = 0;
};

}  // namespace triglyph
