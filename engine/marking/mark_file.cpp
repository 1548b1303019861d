#include "engine/marking/mark_file.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <new>

#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/base/parallel.h"
#include "engine/base/stop.h"
#include "engine/base/text.h"
#include "engine/io/file_bytes.h"
#include "engine/io/gltf.h"
#include "engine/marking/copies.h"
#include "engine/marking/extract.h"
#include "engine/marking/kept_shape.h"
#include "engine/marking/mark.h"
#include "engine/marking/readable.h"
#include "engine/marking/refusal.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/metric/deformation.h"
#include "engine/metric/hausdorff.h"
#include "engine/scheme/registry.h"
#include "engine/trace/displaced_points.h"
#include "engine/trace/fingerprint_reading.h"

namespace triglyph {
namespace {

// by FileStatus
constexpr std::array<std::string_view, 17> kStatusNames = {
    "marked",      "traceable",      "too small",    "positions too coarse",
    "too visible", "already marked", "not verified", "unreadable",
    "malformed",   "unsupported",    "unwritable",   "usage",
    "exists",      "failed",         "crashed",      "too slow",
    "interrupted"};

// Returns nothing for a mesh that was marked.
std::optional<FileStatus> refused_status(MarkStatus status) {
  switch (status) {
    case MarkStatus::Marked:
      return std::nullopt;
    case MarkStatus::TooSmall:
    case MarkStatus::NoFlux:
      return FileStatus::TooSmall;
    case MarkStatus::TooCoarse:
      return FileStatus::TooCoarse;
    case MarkStatus::TooVisible:
      return FileStatus::TooVisible;
    case MarkStatus::AlreadyMarked:
      return FileStatus::AlreadyMarked;
  }
  return FileStatus::Failed;
}

// What a surface gives back of the mark.
struct ReadBack {
  std::vector<Carrier> embedded;  // whose word can be read
  bool has_flux = false;          // the flux layer can be read
  bool is_the_mark = false;
};

}  // namespace

std::string_view name_of(FileStatus status) {
  return kStatusNames.at(static_cast<std::size_t>(status));
}

std::span<const std::string_view> file_status_names() {
  return kStatusNames;
}

FileStatus file_status(ErrorCode code) {
  switch (code) {
    case ErrorCode::Unreadable:
      return FileStatus::Unreadable;
    case ErrorCode::Malformed:
      return FileStatus::Malformed;
    case ErrorCode::Unsupported:
      return FileStatus::Unsupported;
    case ErrorCode::Unwritable:
      return FileStatus::Unwritable;
    case ErrorCode::Usage:
      return FileStatus::Usage;
  }
  return FileStatus::Failed;
}

std::optional<FileStatus> file_status(std::string_view name) {
  const auto at = std::find(kStatusNames.begin(), kStatusNames.end(), name);
  if (at == kStatusNames.end()) return std::nullopt;
  return static_cast<FileStatus>(at - kStatusNames.begin());
}

Encoding MarkedFile::encoding() const {
  Encoding encoding = request.options.encoding();
  encoding.format = format;
  return encoding;
}

double fingerprint_evidence(const MarkedFile& marked, const Surface& surface,
                            const std::optional<Mesh>& original, const Key& key, FluxEffort effort,
                            const std::optional<WordFormat>& format) {
  MarkOptions options = marked.request.options;
  const FingerprintCode code = fingerprint_code(key, options);
  const FingerprintSeed seed = code.seed_of(marked.request.message());
  std::vector<ScoreTable> tables;
  if (!marked.needs_original) {
    if (!marked.flux) options.flux = LayerUse::No;
    std::vector<Encoding> encodings = fingerprint_encodings(options);
    double untried = 0;  // bits that readers pay for ways that are not tried here
    if (format) {
      const auto tried = static_cast<double>(encodings.size());
      std::erase_if(encodings, [&](const Encoding& encoding) {
        return encoding.scheme != kFluxScheme && encoding.format != *format;
      });
      untried =
          std::log2(2 * tried / static_cast<double>(std::max<std::size_t>(1, encodings.size())));
    }
    tables = read_fingerprints(surface, key, code, encodings, effort,
                               format ? ReadTurned::No : ReadTurned::Yes);
    return evidence_of(tables, code, seed).bits - untried;
  } else if (original && original->positions.size() == surface.mesh.positions.size()) {
    const std::vector<Vec3>& positions = surface.mesh.positions;
    const std::vector<std::optional<Vec3>> seen(positions.begin(), positions.end());
    const double farthest = farthest_of_points(options.strength, surface_diagonal(*original));
    tables = score_points(original->positions, seen, farthest, 1);
  }
  return evidence_of(tables, code, seed).bits;
}

struct FileMarking::Work {
  std::shared_ptr<const MeshOfCopies> copies;  // null: the mesh is marked once
  std::shared_ptr<LoadedMesh> mesh;
  Marking marking;
  std::optional<OutputFile> output;

  [[nodiscard]] ReadBack read_from(const Surface& surface, const MarkedFile& wanted,
                                   const Key& key) const;
  [[nodiscard]] bool triangles_would_do(const MarkedFile& wanted, const Key& key) const;
};

// Reads the mark that was made from a surface that should carry it.
ReadBack FileMarking::Work::read_from(const Surface& surface, const MarkedFile& wanted,
                                      const Key& key) const {
  ReadBack read;
  if (marking.flux) {
    const auto flux = read_flux(surface, key, FluxEffort::AsItIs);
    read.has_flux = flux && flux->payload == marking.flux->payload;
    if (!read.has_flux) return read;
  }
  if (marking.words.empty()) {  // the flux layer is all there is
    read.is_the_mark = marking.flux.has_value();
    return read;
  }
  const Extraction found = extract(surface, wanted.encoding(), key);
  read.embedded = carriers_read(marking.carriers, marking.words, found.readings);
  read.is_the_mark =
      wanted.request.is_fill()
          ? !read.embedded.empty() && read.embedded.size() >= marking.carriers.size() * 99 / 100
          : found.message == wanted.request.message();
  return read;
}

// Returns whether the mesh has polygons, and the mark can be read where they stay cut into the
// triangles that were marked.
bool FileMarking::Work::triangles_would_do(const MarkedFile& wanted, const Key& key) const {
  const Mesh& before = mesh->file.mesh();
  if (before.triangles.size() <= mesh->file.face_count()) return false;
  const Mesh marked{marking.positions, before.triangles};
  return read_from({marked, mesh->halfedges}, wanted, key).is_the_mark;
}

FileMarking::FileMarking(std::filesystem::path mesh, std::filesystem::path out, MarkRequest request,
                         std::shared_ptr<const MeshOfCopies> copies)
    : work_(std::make_unique<Work>()) {
  work_->copies = std::move(copies);
  result_.mesh = std::move(mesh);
  result_.out = std::move(out);
  result_.request = std::move(request);
  result_.format = result_.request.options.format;
  result_.status = FileStatus::Marked;  // until a stage finds otherwise
}

FileMarking::~FileMarking() = default;
FileMarking::FileMarking(FileMarking&&) noexcept = default;

// Ends the stages with a status and a reason.
void FileMarking::end(FileStatus status, const std::string& reason) {
  result_.status = status;
  result_.error = result_.mesh.string() + ": " + reason;
}

// Runs one stage unless an earlier one failed. The only place where exceptions are caught.
template <typename Stage>
void FileMarking::run_stage(std::string_view name, double& seconds, const Stage& stage) noexcept {
  if (!result_.is_marked()) return;
  const auto start = std::chrono::steady_clock::now();
  try {
    stage();
  } catch (const Error& error) {
    result_.status = file_status(error.code());
    result_.error = error.path().empty() ? result_.mesh.string() + ": " + error.what()
                                         : std::string(error.what());
  } catch (const Stopped& stopped) {
    end(FileStatus::Interrupted, stopped.what());
  } catch (const std::bad_alloc&) {
    std::error_code ignored;
    const auto bytes = std::filesystem::file_size(result_.mesh, ignored);
    end(FileStatus::Failed, too_little_memory(estimate_memory(ignored ? 0 : bytes, result_.mesh,
                                                              work_of(result_.request))));
  } catch (const std::exception& error) {
    end(FileStatus::Failed, error.what());
  }
  if (!result_.is_marked()) result_.output_hash.clear();
  const auto end = std::chrono::steady_clock::now();
  seconds = std::chrono::duration<double>(end - start).count();
  if (listener_) listener_(name, start, end);
}

void FileMarking::describe(const Marking& marking) {
  // readers of a fingerprint know its formats by what was asked for
  if (!marking.is_fingerprint) result_.format = marking.format;
  if (!marking.scheme_options.empty()) {
    result_.request.options.scheme_options = marking.scheme_options;
  }
  result_.flux = marking.flux;
  result_.needs_original = marking.needs_original;
  result_.colluders = marking.colluders;
  result_.parts = static_cast<std::uint32_t>(marking.words.size());
  result_.candidates = marking.candidates;
  result_.units_valid = marking.units_valid;
  result_.units_bound = marking.units_bound;
  result_.units_assigned = marking.units_assigned;
  result_.cost_max = marking.cost_max;
  result_.cost_sum = marking.cost_sum;
  result_.times.layout = marking.layout_seconds;
  result_.times.assign = marking.assign_seconds;
}

void FileMarking::load() noexcept {
  run_stage("load", result_.times.load, [&] {
    try {
      work_->mesh =
          work_->copies ? work_->copies->loaded(result_.mesh) : LoadedMesh::open(result_.mesh);
    } catch (const Error&) {
      note_input_hash();  // so that a later run knows that it is the same file
      throw;
    }
    const MeshFile& file = work_->mesh->file;
    result_.file_format = name_of(file.format());
    result_.vertices = file.vertex_count();
    result_.points = file.mesh().positions.size();
    result_.faces = file.face_count();
    result_.input_hash = work_->mesh->hash;
    if (!file.why_fixed().empty()) {
      throw Error(ErrorCode::Unsupported, result_.mesh, "",
                  "cannot be marked: " + file.why_fixed());
    }
  });
}

Marking FileMarking::marked_as(const MarkOptions& options, const Key& key) const {
  if (work_->copies) return work_->copies->copy(result_.request.message(), options, key);
  const LoadedMesh& mesh = *work_->mesh;
  return triglyph::mark(mesh.surface(), result_.request.payload, key, options, mesh.rounding(),
                        mesh.file.number_step(), mesh.recut());
}

// Marks the loaded mesh; ends the stages if it is refused.
void FileMarking::mark_as(const MarkOptions& options, const Key& key) {
  const MeshFile& file = work_->mesh->file;
  work_->marking = marked_as(options, key);
  describe(work_->marking);
  if (const auto status = refused_status(work_->marking.status)) {
    const bool had_units =
        work_->marking.units_valid > 0 && work_->marking.units_valid >= work_->marking.parts_needed;
    const bool is_message = options.carry != Carry::Fingerprint;
    if (*status == FileStatus::TooSmall && had_units && is_message && file.has_polygons()) {
      MarkOptions units = options;
      units.flux = LayerUse::No;
      units.carry = Carry::Whole;
      const Marking uncut = triglyph::mark(work_->mesh->surface(), result_.request.payload, key,
                                           units, work_->mesh->rounding(), file.number_step());
      if (uncut.status == MarkStatus::Marked) {
        end(FileStatus::NotVerified, not_read_back(0, uncut.units_assigned, true));
        return;
      }
    }
    std::string reason = refusal(work_->marking, result_.request, file.number_step());
    if (*status == FileStatus::TooCoarse && file.is_decimal()) {
      reason += "; --digits " + std::to_string(result_.digits + 1) + " gives it finer ones";
    }
    end(*status, reason);
  }
}

void FileMarking::write_output() {
  const std::vector<char> bytes = work_->mesh->file.patched(work_->marking.positions);
  work_->output.emplace(result_.out);
  parallel_pair([&] { result_.output_hash = content_hash(bytes); },
                [&] { work_->output->write(bytes); });
}

void FileMarking::mark(const Key& key) noexcept {
  run_stage("mark", result_.times.mark, [&] {
    MarkOptions& options = result_.request.options;
    result_.key_fingerprint = key.fingerprint();
    MeshFile& file = work_->mesh->file;
    if (work_->copies) {  // whose numbers are those of all copies
      mark_as(options, key);
      result_.digits = work_->copies->digits();
      return;
    }
    if (result_.request.is_fill()) {
      options.scheme_options = fixed_for(file.mesh(), options.scheme_options);
    }
    file.set_more_digits(options.digits.value_or(0));
    result_.digits = file.is_decimal() ? options.digits.value_or(0) : 0;
    mark_as(options, key);
    // a message gets one digit more, points that are displaced as many as it takes
    while (result_.status == FileStatus::TooCoarse && file.is_decimal() && !options.digits &&
           result_.digits < (work_->marking.needs_original ? kMostDigits : 1)) {
      result_.status = FileStatus::Marked;
      result_.error.clear();
      ++result_.digits;
      file.set_more_digits(result_.digits);
      mark_as(options, key);
    }
  });
}

void FileMarking::write() noexcept {
  run_stage("write", result_.times.write, [&] { write_output(); });
}

void FileMarking::read_back(const Key& key) noexcept {
  run_stage("read back", result_.times.read_back, [&] {
    if (work_->marking.is_fingerprint) {
      if (reads_fingerprint(key)) result_.status = FileStatus::Traceable;
      return;
    }
    const auto read_written = [&] {
      const Readable written(work_->output->temporary_path());
      return work_->read_from(written.surface(), result_, key);
    };
    ReadBack read = read_written();
    const MarkOptions& options = result_.request.options;
    if (!read.is_the_mark && work_->marking.flux && options.flux == LayerUse::IfPossible) {
      // polygons that are cut differently once marked spoil one layer: the other is enough
      MarkOptions alone = options;
      alone.flux = read.has_flux ? LayerUse::Yes : LayerUse::No;
      alone.units = read.has_flux ? LayerUse::No : LayerUse::Yes;
      mark_as(alone, key);
      if (!result_.is_marked()) return;
      write_output();
      read = read_written();
    }
    result_.units_embedded = static_cast<std::uint32_t>(read.embedded.size());
    if (!read.is_the_mark) {
      end(FileStatus::NotVerified, not_read_back(result_.units_embedded, result_.units_assigned,
                                                 work_->triangles_would_do(result_, key)));
      return;
    }
    if (options.detail) result_.units = std::move(read.embedded);
  });
}

// Returns whether the output's fingerprint is of use; otherwise ends the stages.
bool FileMarking::reads_fingerprint(const Key& key) {
  const Marking& marking = work_->marking;
  const Readable written(work_->output->temporary_path());
  result_.evidence = fingerprint_evidence(result_, written.surface(), work_->mesh->file.mesh(), key,
                                          FluxEffort::AsItIs, marking.format);
  result_.units_embedded = static_cast<std::uint32_t>(marking.carriers.size());
  if (result_.request.options.detail) result_.units = marking.carriers;
  if (result_.evidence >= kTraceable) return true;
  end(FileStatus::TooSmall, too_little_evidence(result_.evidence, kTraceable));
  return false;
}

void FileMarking::measure() noexcept {
  run_stage("measure", result_.times.measure, [&] {
    const Mesh& mesh = work_->mesh->file.mesh();
    const std::vector<Vec3>& marked = work_->marking.positions;
    const Displacement moved = displacement(mesh.positions, marked);
    result_.displacement_max = moved.max;
    result_.displacement_rms = moved.rms;
    const double diagonal = surface_diagonal(mesh);
    result_.hausdorff =
        hausdorff_of_move(mesh.triangles, mesh.positions, marked, kHausdorffTolerance * diagonal)
            .symmetric();
    result_.hausdorff_rel_diag = result_.hausdorff / diagonal;
  });
}

void FileMarking::publish(bool keeps_time) noexcept {
  double seconds = 0;
  run_stage("publish", seconds, [&] {
    const std::filesystem::path& output = work_->output->temporary_path();
    // a file system without permissions or times is no reason to refuse
    std::error_code ignored;
    const auto status = std::filesystem::status(result_.mesh, ignored);
    if (!ignored) std::filesystem::permissions(output, status.permissions(), ignored);
    if (keeps_time) {
      const auto time = std::filesystem::last_write_time(result_.mesh, ignored);
      if (!ignored) std::filesystem::last_write_time(output, time, ignored);
    }
    work_->output->commit();
  });
  result_.times.write += seconds;
  work_.reset();
}

std::vector<char> FileMarking::kept_shape() const noexcept {
  const MarkOptions& options = result_.request.options;
  const bool is_copy =
      result_.status == FileStatus::Traceable || options.carry == Carry::Fingerprint;
  const bool has_flux = options.flux != LayerUse::No && !result_.needs_original;
  if (work_ == nullptr || !result_.is_marked() || !is_copy || !has_flux) return {};
  try {
    const std::optional<KeptShape> shape = KeptShape::of(work_->mesh->surface());
    return shape ? shape->bytes() : std::vector<char>();
  } catch (const std::exception&) {
    return {};
  }
}

void FileMarking::note_input_hash() noexcept {
  try {
    result_.input_hash = content_hash(FileBytes::open(result_.mesh).bytes());
  } catch (const std::exception&) {
    result_.input_hash.clear();
  }
}

void FileMarking::interrupt() noexcept {
  refuse(FileStatus::Interrupted, "interrupted");
}

void FileMarking::refuse(FileStatus status, const std::string& reason) noexcept {
  if (result_.is_marked()) end(status, reason);
}

MarkedFile mark_file(const std::filesystem::path& mesh, const std::filesystem::path& out,
                     const MarkRequest& request, const Key& key) {
  FileMarking marking(mesh, out, request);
  marking.load();
  marking.mark(key);
  marking.write();
  marking.read_back(key);
  marking.measure();
  marking.publish();
  return marking.result();
}

MeshWork work_of(const MarkRequest& request) {
  if (request.is_fill()) return MeshWork::Fill;
  return request.options.flux == LayerUse::No ? MeshWork::Usual : MeshWork::Flux;
}

std::uint64_t estimate_memory(std::uint64_t file_bytes, const std::filesystem::path& mesh,
                              MeshWork work) {
  // Measured at 1 to 20 million triangles: bytes of memory per byte of the file, with a quarter
  // added, and the fewest bytes of the file per vertex with its two triangles.
  struct Format {
    std::string_view ending;
    std::uint64_t memory;
    std::uint64_t file_bytes_a_vertex;
  };
  constexpr std::array<Format, 6> kFormats = {{{".ply", 18, 38},
                                               {".stl", 10, 100},
                                               {".off", 10, 45},
                                               {".obj", 10, 60},
                                               {".glb", 28, 24},
                                               {".gltf", 21, 32}}};
  const std::string ending = lower_case_ending(mesh);
  const auto known = std::find_if(kFormats.begin(), kFormats.end(),
                                  [&](const Format& format) { return format.ending == ending; });
  const Format& format = known == kFormats.end() ? kFormats.front() : *known;
  constexpr std::uint64_t kProgram = std::uint64_t{1} << 20;
  std::uint64_t bytes = kProgram + file_bytes * format.memory;
  if (ending == ".glb") {
    // Most of many files is pictures, which are read and written, but not worked on: twice their
    // size was measured.
    const std::uint64_t geometry = geometry_bytes_of_glb(mesh).value_or(file_bytes);
    bytes = kProgram + file_bytes / 2 * 5 + geometry * format.memory;
    file_bytes = geometry;
  }
  if (work == MeshWork::Flux) {
    // Derivatives, frame rows and the thin plate: 1,200 bytes a vertex were measured at 1.1
    // and 1.25 million triangles, for a file of 81 bytes a vertex or more, with a quarter added.
    constexpr std::uint64_t kFluxBytesAVertex = 1500;
    bytes = std::max(bytes, kProgram + file_bytes / format.file_bytes_a_vertex * kFluxBytesAVertex);
  }
  if (work == MeshWork::Fill) {
    // The cost matrix, and a copy of it for the candidate lists. No layout has more units than a
    // sixth of the vertices, and larger matrices are split into blocks.
    const std::uint64_t units = file_bytes / format.file_bytes_a_vertex / 6;
    constexpr std::uint64_t kMostPairs = std::uint64_t{1} << 26;
    const bool is_large = units >= std::uint64_t{1} << 13;
    bytes += 2 * sizeof(float) * (is_large ? kMostPairs : units * units);
  }
  return bytes;
}

}  // namespace triglyph
