#include "manifests/pipeline.h"

#include <algorithm>
#include <chrono>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/geometry/box.h"
#include "engine/metric/deformation.h"
#include "engine/metric/hausdorff.h"
#include "manifests/readable.h"

namespace triglyph {
namespace {

Status status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::Unreadable:
      return Status::Unreadable;
    case ErrorCode::Malformed:
      return Status::Malformed;
    case ErrorCode::Unsupported:
      return Status::Unsupported;
    case ErrorCode::Unwritable:
      return Status::Unwritable;
    case ErrorCode::Usage:
      return Status::Usage;
  }
  return Status::Failed;
}

// Ends the task's way with a reason.
void end(Task& task, Status status, const std::string& reason) {
  task.record.status = status;
  task.record.error = reason;
}

// Runs one stage of a task that still stands; the one place where exceptions stop.
template <typename Stage>
void run_stage(Task& task, double& seconds, const Stage& stage) noexcept {
  const auto start = std::chrono::steady_clock::now();
  try {
    stage();
  } catch (const Error& error) {
    end(task, status_of(error.code()),
        error.path().empty() ? task.record.job.mesh.string() + ": " + error.what() : error.what());
  } catch (const std::bad_alloc&) {
    end(task, Status::Failed, task.record.job.mesh.string() + ": not enough memory");
  } catch (const std::exception& error) {
    end(task, Status::Failed, task.record.job.mesh.string() + ": " + error.what());
  }
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void describe(const Marking& marking, Record& record) {
  record.format = marking.format;
  record.parts = static_cast<std::uint32_t>(marking.words.size());
  record.candidates = marking.candidates;
  record.units_valid = marking.units_valid;
  record.units_bound = marking.units_bound;
  record.units_assigned = marking.units_assigned;
  record.cost_max = marking.cost_max;
  record.cost_sum = marking.cost_sum;
  record.times.layout = marking.layout_seconds;
  record.times.assign = marking.assign_seconds;
}

}  // namespace

void load(Task& task) noexcept {
  run_stage(task, task.record.times.load, [&] {
    Record& record = task.record;
    record.options = record.job.settings.resolved();
    record.format = record.options.format;
    record.status = Status::Marked;  // until a stage finds otherwise
    task.file = MeshFile::open(record.job.mesh);
    record.file_format = name_of(task.file->format());
    record.vertices = task.file->vertex_count();
    record.points = task.file->mesh().positions.size();
    record.faces = task.file->face_count();
    parallel_pair([&] { record.input_hash = content_hash(task.file->bytes()); },
                  [&] { task.halfedges = build_halfedges(task.file->mesh()); });
  });
}

void mark(Task& task, const Key& key) noexcept {
  if (!task.stands()) return;
  run_stage(task, task.record.times.mark, [&] {
    Record& record = task.record;
    const JobSettings& settings = record.job.settings;
    record.key_fingerprint = key.fingerprint();
    if (settings.fill) {
      record.options.scheme_options = fixed_for(task.file->mesh(), record.options.scheme_options);
    }
    task.marking = mark(
        {task.file->mesh(), *task.halfedges}, settings.fill ? Message{} : settings.message, key,
        record.options, [&](const Vec3& point) { return task.file->round(point); },
        task.file->number_step());
    describe(task.marking, record);
    const std::string name = record.job.mesh.string() + ": ";
    if (task.marking.status == MarkStatus::TooSmall) {
      end(task, Status::TooSmall,
          name + std::to_string(record.units_valid) + " units carry " +
              std::to_string(task.marking.parts_carried) + " of the message's " +
              std::to_string(record.parts) + " parts");
    } else if (task.marking.status == MarkStatus::TooCoarse) {
      end(task, Status::TooCoarse,
          name + "numbers " + std::to_string(task.file->number_step()) +
              " apart are too coarse for the mark");
    }
  });
}

void write(Task& task) noexcept {
  if (!task.stands()) return;
  run_stage(task, task.record.times.write, [&] {
    const std::vector<char> bytes = task.file->patched(task.marking.positions);
    task.output.emplace(task.record.job.out);
    parallel_pair([&] { task.record.output_hash = content_hash(bytes); },
                  [&] { task.output->write(bytes); });
  });
}

void read_back(Task& task, const Key& key) noexcept {
  if (!task.stands()) return;
  run_stage(task, task.record.times.read_back, [&] {
    Record& record = task.record;
    const JobSettings& settings = record.job.settings;
    const WordCode code(key, record.format);
    const auto scheme = make_scheme(record.options.scheme, code, record.options.scheme_options);
    const Readable written(task.output->temporary_path());
    const Extraction found = extract(*scheme->bind(written.surface()), code,
                                     record.options.scheme_options.doubtful_parts);
    std::vector<Carrier> embedded =
        carriers_read(task.marking.carriers, task.marking.words, found.readings);
    record.units_embedded = static_cast<std::uint32_t>(embedded.size());
    if (settings.wants_detail()) record.units = std::move(embedded);
    const bool verified = settings.fill
                              ? record.units_embedded > 0 &&
                                    record.units_embedded >= task.marking.carriers.size() * 99 / 100
                              : found.message == settings.message;
    if (verified) {
      task.output->commit();
    } else {
      end(task, Status::NotVerified,
          record.job.mesh.string() + ": the mark could not be read back (" +
              std::to_string(record.units_embedded) + " of " +
              std::to_string(record.units_assigned) + " units)");
      record.output_hash.clear();
    }
  });
  task.output.reset();
}

void measure(Task& task) noexcept {
  if (task.stands()) {
    run_stage(task, task.record.times.measure, [&] {
      Record& record = task.record;
      const Mesh& mesh = task.file->mesh();
      const Displacement moved = displacement(mesh.positions, task.marking.positions);
      record.displacement_max = moved.max;
      record.displacement_rms = moved.rms;
      const double diagonal = box_diagonal(mesh.positions);
      record.hausdorff = hausdorff_of_move(mesh.triangles, mesh.positions, task.marking.positions,
                                           kHausdorffTolerance * diagonal)
                             .symmetric();
      record.hausdorff_rel_diag = record.hausdorff / diagonal;
    });
  }
  task.output.reset();
  task.marking = {};
  task.halfedges.reset();
  task.file.reset();
}

FileExtraction extract_file(const std::filesystem::path& path, const Key& key,
                            const MarkOptions& options) {
  const Readable readable(path);
  const WordCode code(key, options.format);
  const auto scheme = make_scheme(options.scheme, code, options.scheme_options);
  return {extract(*scheme->bind(readable.surface()), code, options.scheme_options.doubtful_parts),
          readable.file.vertex_count(), readable.file.face_count()};
}

std::uint64_t estimate_memory(std::uint64_t file_bytes, std::string_view extension) {
  // Measured: 8 bytes of memory for a byte of OBJ or binary STL, 15 for one of binary PLY, at 1 to
  // 20 million triangles; a quarter on top.
  const bool text_or_stl = extension != ".ply";
  return (std::uint64_t{1} << 20) + file_bytes * (text_or_stl ? 10 : 18);
}

}  // namespace triglyph
