#include "manifests/record.h"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/base/error.h"
#include "manifests/json_line.h"

namespace triglyph {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void refuse(const std::string& reason) {
  throw Error(ErrorCode::Malformed, {}, "", reason);
}

// Returns a number that must be whole and fit; the library's own conversion rounds and wraps.
template <typename Number>
Number whole_number(const Json& json) {
  if (!json.is_number_unsigned() ||
      json.get<std::uint64_t>() > std::numeric_limits<Number>::max()) {
    refuse(json.dump() + " is not a whole number that can stand there");
  }
  return json.get<Number>();
}

// Likewise; 0 if the key is missing.
template <typename Number>
Number whole_number(const Json& json, const char* key) {
  return json.contains(key) ? whole_number<Number>(json.at(key)) : Number{0};
}

// Returns the values of all options, in the order of help.
Json options_of(const MarkedFile& file) {
  MarkOptions options = file.request.options;
  options.format = file.format;
  const OptionValues values = values_of(options);
  Json json = Json::object();
  for (const OptionSpec& spec : mark_option_specs()) {
    const auto found = values.find(spec.key);
    if (found != values.end() && spec.key != "scheme") json[spec.key] = to_json(found->second);
  }
  return json;
}

// [[anchor, part], ...]
Json units_of(std::span<const Carrier> carriers) {
  Json json = Json::array();
  for (const Carrier& carrier : carriers) json.push_back({carrier.anchor, carrier.word});
  return json;
}

std::vector<Carrier> units_in(const Json& json, std::uint32_t parts) {
  std::vector<Carrier> carriers;
  for (const auto& unit : json) {
    carriers.push_back(
        {whole_number<std::uint32_t>(unit.at(0)), whole_number<std::uint32_t>(unit.at(1))});
    const bool ascends =
        carriers.size() < 2 || carriers[carriers.size() - 2].anchor < carriers.back().anchor;
    if (!ascends || carriers.back().word >= parts) refuse("units that cannot be");
  }
  return carriers;
}

// by FluxContent
constexpr std::array<const char*, 3> kFluxContentNames = {"message", "number", "fingerprint"};

Json flux_of(const FluxMark& mark) {
  const bool has_payload = mark.payload.content != FluxContent::Fingerprint;
  return {{"content", kFluxContentNames.at(static_cast<std::size_t>(mark.payload.content))},
          {"bits", mark.payload.bits},
          {"value", has_payload ? to_hex(bytes_of(mark.payload)) : ""},
          {"step", mark.step},
          {"rms_percent", mark.rms_percent},
          {"expected_evidence", mark.expected_evidence},
          {"functionals", mark.functionals}};
}

void read_payload(const Json& json, FluxPayload& payload) {
  const std::vector<std::uint8_t> bytes = from_hex(json.at("value").get<std::string>());
  const auto known = std::find(kPayloadBits.begin(), kPayloadBits.end(), payload.bits);
  if (known == kPayloadBits.end() || 8 * bytes.size() != static_cast<std::size_t>(*known)) {
    refuse("a flux layer that cannot be");
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    payload.value |= std::uint64_t{bytes[i]} << (8 * i);
  }
}

FluxMark flux_in(const Json& json) {
  FluxMark mark;
  const auto content = json.at("content").get<std::string>();
  const auto name = std::find(kFluxContentNames.begin(), kFluxContentNames.end(), content);
  if (name == kFluxContentNames.end()) refuse("unknown content " + content);
  mark.payload.content = static_cast<FluxContent>(name - kFluxContentNames.begin());
  mark.payload.bits = whole_number<std::uint8_t>(json.at("bits"));
  if (mark.payload.content != FluxContent::Fingerprint) read_payload(json, mark.payload);
  mark.step = json.value("step", 0.0);
  mark.rms_percent = json.value("rms_percent", 0.0);
  mark.expected_evidence = json.value("expected_evidence", 0.0);
  mark.functionals = whole_number<std::uint32_t>(json, "functionals");
  return mark;
}

Json run_of(const Record& record) {
  const StageTimes& times = record.file.times;
  Json run = {{"load_s", times.load},
              {"mark_s", times.mark},
              {"layout_s", times.layout},
              {"assign_s", times.assign},
              {"write_s", times.write},
              {"read_back_s", times.read_back},
              {"measure_s", times.measure},
              {"memory_estimate", record.memory_estimate},
              {"peak_bytes", record.peak_bytes},
              {"directory", record.directory}};
  if (!record.shard.empty()) {
    run["shard"] = record.shard;
    run["jobs"] = record.jobs;
  }
  run["place"] = record.index;  // the last: RecordsFile looks for it there
  return run;
}

void read_run(const Json& run, Record& record) {
  StageTimes& times = record.file.times;
  const auto seconds = [&](const char* key, double& value) { value = run.value(key, 0.0); };
  seconds("load_s", times.load);
  seconds("mark_s", times.mark);
  seconds("layout_s", times.layout);
  seconds("assign_s", times.assign);
  seconds("write_s", times.write);
  seconds("read_back_s", times.read_back);
  seconds("measure_s", times.measure);
  record.memory_estimate = whole_number<std::uint64_t>(run, "memory_estimate");
  record.peak_bytes = whole_number<std::uint64_t>(run, "peak_bytes");
  record.directory = run.value("directory", std::string());
  record.shard = run.value("shard", std::string());
  if (!record.shard.empty()) record.jobs = whole_number<std::uint64_t>(run, "jobs");
  record.index = whole_number<std::size_t>(run, "place");
}

// Returns the request of a record. From schema 1, in which some options are shares, it takes only
// those that a reader needs, which are the same in both schemas.
MarkRequest request_in(const Json& json, int schema) {
  OptionValues values;
  for (const auto& [key, value] : json.at("options").items()) {
    const OptionSpec* spec = find_mark_option(key);
    const bool was_share = schema == 1 && key == "drop_dearest";
    if (spec != nullptr && !was_share) {
      values.emplace(key, spec->checked(option_value(key, value)));
    } else if (schema > 1) {
      refuse("unknown option \"" + key + "\"");
    }
  }
  values["scheme"] = json.at("scheme").get<std::string>();
  // marks of the first generation were recorded before there was a second encoding
  const bool is_iie = values["scheme"] == OptionValue(std::string("iie"));
  if (is_iie) values.emplace("iie_encoding", std::string("global"));
  values["fill"] = json.at("fill").get<bool>();
  if (values["fill"] == OptionValue(false)) {
    values["message_hex"] = json.at("message_hex").get<std::string>();
  }
  return resolve(values);
}

}  // namespace

Json to_json(const Record& record) {
  const MarkedFile& file = record.file;
  const MarkRequest& request = file.request;
  Json json = {{"schema", kRecordSchema}};
  put_path(json, "mesh", file.mesh);
  put_path(json, "out", file.out);
  json["scheme"] = request.options.scheme_name();
  json["status"] = name_of(file.status);
  if (!file.error.empty()) json["error"] = file.error;
  json.update(Json{{"file_format", file.file_format},
                   {"vertices", file.vertices},
                   {"points", file.points},
                   {"faces", file.faces},
                   {"candidates", file.candidates},
                   {"units_valid", file.units_valid},
                   {"units_assigned", file.units_assigned},
                   {"units_embedded", file.units_embedded},
                   {"units_bound", file.units_bound},
                   {"parts", file.parts},
                   {"fill", request.is_fill()}});
  if (!request.is_fill()) {
    json["message_hex"] = to_hex(request.message());
    json["message_bits"] = 8 * request.message().size();
    if (request.options.carry == Carry::Fingerprint) {
      put_path(json, "recipient", std::string(request.message().begin(), request.message().end()));
    }
  } else {
    json["message_bits"] = std::uint64_t{file.parts} * file.format.part_bits;
  }
  // what was not marked has no distance, not a distance of zero
  if (file.is_marked()) {
    json.update(Json{{"cost_max", file.cost_max},
                     {"cost_sum", file.cost_sum},
                     {"hausdorff", file.hausdorff},
                     {"hausdorff_rel_diag", file.hausdorff_rel_diag},
                     {"displacement_max", file.displacement_max},
                     {"displacement_rms", file.displacement_rms}});
  }
  if (file.flux) json["flux"] = flux_of(*file.flux);
  if (file.status == FileStatus::Traceable) json["evidence_bits"] = file.evidence;
  if (file.needs_original) json["needs_original"] = true;
  if (file.colluders > 1) json["resists_colluders"] = file.colluders;
  if (file.digits > 0) json["digits"] = file.digits;
  json.update(Json{{"input_hash", file.input_hash},
                   {"output_hash", file.output_hash},
                   {"key", file.key_fingerprint},
                   {"options", options_of(file)}});
  if (file.units) json["units"] = units_of(*file.units);
  json["run"] = run_of(record);
  return json;
}

std::string line_of(const Record& record) {
  return record.line.empty() ? to_line(to_json(record)) : record.line;
}

Record parse_record(const std::string& line) try {
  const Json json = parse_json_line(line);
  const auto schema = whole_number<std::uint8_t>(json, "schema");
  if (schema < 1 || schema > kRecordSchema) {
    refuse("not a record of schema 1 to " + std::to_string(kRecordSchema));
  }
  Record record;
  MarkedFile& file = record.file;
  file.mesh = path_in(json, "mesh");
  file.out = path_in(json, "out");
  const auto status = file_status(json.at("status").get<std::string>());
  if (!status) refuse("unknown status " + json.at("status").dump());
  file.status = *status;
  file.error = json.value("error", std::string());
  file.request = request_in(json, schema);
  file.format = file.request.options.format;
  file.file_format = json.value("file_format", std::string());
  const auto count = [&](const char* key, std::uint32_t& value) {
    value = whole_number<std::uint32_t>(json, key);
  };
  file.vertices = whole_number<std::uint64_t>(json, "vertices");
  file.points = whole_number<std::uint64_t>(json.at("points"));
  file.faces = whole_number<std::uint64_t>(json.at("faces"));
  count("candidates", file.candidates);
  count("units_valid", file.units_valid);
  count("units_assigned", file.units_assigned);
  count("units_bound", file.units_bound);
  file.parts = whole_number<std::uint32_t>(json.at("parts"));
  file.units_embedded = whole_number<std::uint32_t>(json.at("units_embedded"));
  const auto number = [&](const char* key, double& value) { value = json.value(key, 0.0); };
  number("cost_max", file.cost_max);
  number("cost_sum", file.cost_sum);
  number("hausdorff", file.hausdorff);
  number("hausdorff_rel_diag", file.hausdorff_rel_diag);
  number("displacement_max", file.displacement_max);
  number("displacement_rms", file.displacement_rms);
  file.input_hash = json.value("input_hash", std::string());
  file.output_hash = json.at("output_hash").get<std::string>();
  file.key_fingerprint = json.at("key").get<std::string>();
  number("evidence_bits", file.evidence);
  file.needs_original = json.value("needs_original", false);
  file.colluders = json.value("resists_colluders", 1);
  if (json.contains("flux")) file.flux = flux_in(json.at("flux"));
  file.digits = json.value("digits", 0);
  if (json.contains("units")) file.units = units_in(json.at("units"), file.parts);
  if (json.contains("run")) read_run(json.at("run"), record);
  return record;
} catch (const Json::exception& error) {
  refuse(error.what());
} catch (const Error& error) {
  if (error.code() == ErrorCode::Malformed) throw;
  refuse(error.message());
}

}  // namespace triglyph
