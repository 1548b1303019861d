// The shared library's functions: text becomes typed options, and results become plain values.
#include <triglyph/triglyph.h>

#include "engine/base/error.h"
#include "engine/flux/flux_mark.h"
#include "engine/marking/mark_file.h"
#include "engine/marking/read_file.h"
#include "engine/marking/verify_file.h"
#include "manifests/json_line.h"
#include "manifests/record.h"

namespace triglyph {

struct SecretKey::Secret {
  Key key;
};

namespace {

OptionValues values_of(const Settings& settings) {
  OptionValues values;
  for (const auto& [key, text] : settings) {
    const OptionSpec* spec = find_mark_option(key);
    if (spec == nullptr) throw Error(ErrorCode::Usage, {}, "", "unknown option \"" + key + "\"");
    values.emplace(key, spec->parsed(text));
  }
  return values;
}

}  // namespace

std::string_view version() {
  return TRIGLYPH_VERSION;
}

SecretKey::SecretKey(std::shared_ptr<const Secret> secret) : secret_(std::move(secret)) {}

SecretKey SecretKey::trial() {
  return SecretKey(std::make_shared<const Secret>(Secret{Key::trial()}));
}

SecretKey SecretKey::generate() {
  return SecretKey(std::make_shared<const Secret>(Secret{Key::generate()}));
}

SecretKey SecretKey::load(const std::filesystem::path& path) {
  return SecretKey(std::make_shared<const Secret>(Secret{Key::load(path)}));
}

void SecretKey::save(const std::filesystem::path& path) const {
  secret_->key.save(path);
}

std::string SecretKey::fingerprint() const {
  return secret_->key.fingerprint();
}

std::vector<SettingInfo> mark_settings() {
  std::vector<SettingInfo> all;
  for (const OptionSpec& spec : mark_option_specs()) {
    all.push_back({spec.key, spec.domain(), spec.default_text, spec.help});
  }
  return all;
}

MarkReport mark_file(const std::filesystem::path& mesh, const std::filesystem::path& out,
                     const Settings& settings, const SecretKey& key) {
  const OptionValues values = values_of(settings);
  check_contradictions(values, scheme_of(values));
  std::error_code error;
  if (std::filesystem::equivalent(mesh, out, error)) {
    throw Error(ErrorCode::Usage, out, "", "the output would overwrite the input");
  }
  const Record record{mark_file(mesh, out, resolve(values), key.secret().key)};
  const MarkedFile& file = record.file;
  return {.marked = file.is_marked(),
          .status = std::string(name_of(file.status)),
          .error = file.error,
          .vertices = file.vertices,
          .faces = file.faces,
          .units = file.units_embedded,
          .hausdorff = file.hausdorff,
          .hausdorff_rel_diag = file.hausdorff_rel_diag,
          .record = to_line(to_json(record))};
}

ReadReport read_file(const std::filesystem::path& path, std::span<const SecretKey> keys,
                     const Settings& settings) {
  if (keys.empty()) throw Error(ErrorCode::Usage, {}, "", "no key to read with");
  const OptionValues values = values_of(settings);
  check_contradictions(values, values.contains("scheme") ? scheme_of(values) : "");
  std::vector<Key> secrets;
  for (const SecretKey& key : keys) secrets.push_back(key.secret().key);
  const FileReading reading = read_file(path, encodings_of(values), secrets);
  ReadReport report;
  report.false_alarm = reading.false_alarm;
  if (const auto& mark = reading.mark) {
    if (mark->flux && mark->flux->payload.content == FluxContent::Number) {
      report.number = to_hex(bytes_of(mark->flux->payload));
    } else {
      report.message = std::string(mark->message.begin(), mark->message.end());
    }
    report.scheme = mark->encoding.scheme;
    report.key = mark->key;
    report.units_agreeing = mark->agreeing;
  }
  return report;
}

VerifyReport verify_file(std::string_view record, const SecretKey& key) {
  const Record written = parse_record(std::string(record));
  const Verification found = verify_file(written.file, key.secret().key, true);
  VerifyReport report;
  report.verdict = name_of(found.verdict);
  report.detail = found.detail;
  report.units_found = found.units_found;
  if (found.damage) report.damaged_vertices = found.damage->vertices;
  return report;
}

}  // namespace triglyph
