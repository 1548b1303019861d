#include "manifests/record.h"

#include <array>

#include "engine/base/error.h"

namespace triglyph {
namespace {

using Json = nlohmann::ordered_json;

struct StatusName {
  Status status;
  std::string_view name;
};
constexpr std::array<StatusName, 11> kStatusNames{{{Status::Marked, "marked"},
                                                   {Status::TooSmall, "too small"},
                                                   {Status::TooCoarse, "positions too coarse"},
                                                   {Status::NotVerified, "not verified"},
                                                   {Status::Unreadable, "unreadable"},
                                                   {Status::Malformed, "malformed"},
                                                   {Status::Unsupported, "unsupported"},
                                                   {Status::Unwritable, "unwritable"},
                                                   {Status::Usage, "usage"},
                                                   {Status::Failed, "failed"},
                                                   {Status::Interrupted, "interrupted"}}};

Status status_named(const std::string& name) {
  for (const StatusName& known : kStatusNames) {
    if (known.name == name) return known.status;
  }
  throw Error(ErrorCode::Malformed, {}, "", "unknown status \"" + name + "\"");
}

Json options_of(const Record& record) {
  const MarkOptions& options = record.options;
  const SchemeOptions& scheme = options.scheme_options;
  Json json = {{"layout", name_of(options.layout.method)},
               {"layout_iterations", options.layout.iterations},
               {"layout_seconds", options.layout.seconds},
               {"layout_seed", options.layout.seed},
               {"conflicts", name_of(options.conflict_rule)},
               {"assign", name_of(options.assign)},
               {"cost", name_of(scheme.cost)},
               {"redundancy", options.redundancy},
               {"max_move_rel_diag", options.max_move_rel_diag},
               {"drop_dearest", options.drop_dearest},
               {"marker_bits", record.format.marker_bits},
               {"subscript_bits", record.format.subscript_bits},
               {"part_bits", record.format.part_bits},
               {"step", scheme.step}};
  if (options.scheme == "aie") json["aie_groups"] = name_of(scheme.groups);
  if (options.scheme == "iie") {
    json["radius_edges"] = scheme.radius_edges;
    json["radius"] = scheme.radius;
    json["centre_rings"] = scheme.centre_rings;
    json["site_rings"] = scheme.site_rings;
    json["doubtful_parts"] = scheme.doubtful_parts;
  }
  return json;
}

// [[anchor, part], ...]
Json units_of(std::span<const Carrier> carriers) {
  Json json = Json::array();
  for (const Carrier& carrier : carriers) json.push_back({carrier.anchor, carrier.word});
  return json;
}

std::vector<Carrier> units_in(const nlohmann::json& json, std::uint32_t parts) {
  std::vector<Carrier> carriers;
  for (const auto& unit : json) {
    carriers.push_back({unit.at(0).get<std::uint32_t>(), unit.at(1).get<std::uint32_t>()});
    const bool ascends =
        carriers.size() < 2 || carriers[carriers.size() - 2].anchor < carriers.back().anchor;
    if (!ascends || carriers.back().word >= parts) {
      throw Error(ErrorCode::Malformed, {}, "", "units that cannot be");
    }
  }
  return carriers;
}

// What extraction must know of them.
SchemeOptions scheme_options_of(const nlohmann::json& options) {
  SchemeOptions scheme;
  scheme.step = options.at("step").get<double>();
  scheme.groups = aie_groups(options.value("aie_groups", std::string(name_of(scheme.groups))));
  scheme.radius_edges = options.value("radius_edges", scheme.radius_edges);
  scheme.radius = options.value("radius", scheme.radius);
  scheme.doubtful_parts = options.value("doubtful_parts", scheme.doubtful_parts);
  scheme.centre_rings = options.value("centre_rings", scheme.centre_rings);
  scheme.site_rings = options.value("site_rings", scheme.site_rings);
  return scheme;
}

}  // namespace

std::string_view name_of(Status status) {
  for (const StatusName& known : kStatusNames) {
    if (known.status == status) return known.name;
  }
  return "failed";
}

Json to_json(const Record& record, std::uint64_t peak_bytes) {
  const JobSettings& settings = record.job.settings;
  Json json = {{"schema", kRecordSchema},
               {"mesh", record.job.mesh.string()},
               {"out", record.job.out.string()},
               {"scheme", settings.scheme},
               {"status", name_of(record.status)}};
  if (!record.error.empty()) json["error"] = record.error;
  json.update(Json{{"file_format", record.file_format},
                   {"vertices", record.vertices},
                   {"points", record.points},
                   {"faces", record.faces},
                   {"candidates", record.candidates},
                   {"units_valid", record.units_valid},
                   {"units_assigned", record.units_assigned},
                   {"units_embedded", record.units_embedded},
                   {"units_bound", record.units_bound},
                   {"parts", record.parts},
                   {"fill", settings.fill}});
  if (!settings.fill) {
    json["message_hex"] = to_hex(settings.message);
    json["message_bits"] = 8 * settings.message.size();
  } else {
    json["message_bits"] = std::uint64_t{record.parts} * record.format.part_bits;
  }
  json.update(Json{{"cost_max", record.cost_max},
                   {"cost_sum", record.cost_sum},
                   {"hausdorff", record.hausdorff},
                   {"hausdorff_rel_diag", record.hausdorff_rel_diag},
                   {"displacement_max", record.displacement_max},
                   {"displacement_rms", record.displacement_rms},
                   {"input_hash", record.input_hash},
                   {"output_hash", record.output_hash},
                   {"key", record.key_fingerprint},
                   {"options", options_of(record)}});
  if (settings.wants_detail() && record.status == Status::Marked) {
    json["units"] = units_of(record.units);
  }
  json.update(Json{{"run",
                    {{"load_s", record.times.load},
                     {"mark_s", record.times.mark},
                     {"layout_s", record.times.layout},
                     {"assign_s", record.times.assign},
                     {"write_s", record.times.write},
                     {"read_back_s", record.times.read_back},
                     {"measure_s", record.times.measure},
                     {"memory_estimate", record.memory_estimate},
                     {"peak_bytes", peak_bytes}}}});
  return json;
}

std::string to_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

RecordedMark parse_record(const std::string& line) try {
  const auto json = nlohmann::json::parse(line);
  if (!json.is_object() || json.value("schema", 0) != kRecordSchema) {
    throw Error(ErrorCode::Malformed, {}, "", "not a record of schema 1");
  }
  RecordedMark mark;
  mark.out = json.at("out").get<std::string>();
  mark.status = status_named(json.at("status").get<std::string>());
  mark.fill = json.at("fill").get<bool>();
  if (!mark.fill) mark.message = from_hex(json.at("message_hex"));
  const auto& options = json.at("options");
  mark.options.scheme = json.at("scheme").get<std::string>();
  mark.options.scheme_options = scheme_options_of(options);
  mark.options.format = {options.at("marker_bits").get<int>(),
                         options.at("subscript_bits").get<int>(),
                         options.at("part_bits").get<int>()};
  validate(mark.options.format);
  mark.parts = json.at("parts").get<std::uint32_t>();
  mark.units_embedded = json.at("units_embedded").get<std::uint32_t>();
  mark.points = json.at("points").get<std::uint64_t>();
  mark.faces = json.at("faces").get<std::uint64_t>();
  if (json.contains("units")) mark.units = units_in(json.at("units"), mark.parts);
  mark.output_hash = json.at("output_hash").get<std::string>();
  mark.key_fingerprint = json.at("key").get<std::string>();
  return mark;
} catch (const nlohmann::json::exception& error) {
  throw Error(ErrorCode::Malformed, {}, "", error.what());
}

}  // namespace triglyph
