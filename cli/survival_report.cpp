#include "cli/survival_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "engine/base/options.h"
#include "engine/base/text.h"
#include "manifests/json_line.h"

namespace triglyph {
namespace {

constexpr int kNameWidth = 24;
constexpr int kColumnWidth = 26;

template <typename... Values>
std::string formatted(const char* form, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), form, values...);
  return text.data();
}

std::string padded(std::string text, int width) {
  text.resize(std::max(text.size() + 1, static_cast<std::size_t>(width)), ' ');
  return text;
}

void print_row(std::ostream& out, const std::string& name, const std::vector<std::string>& cells) {
  std::string line = padded(name, kNameWidth);
  for (const std::string& cell : cells) line += padded(cell, kColumnWidth);
  out << line.substr(0, line.find_last_not_of(' ') + 1) << "\n";
}

// "3/4   0.0   1.9  2^-32": read, wrong bits in percent in the median and at worst, false alarm.
std::string cell_of(const AttackSurvival& survival) {
  if (survival.wrong_bits.empty()) return "-";
  std::string cell =
      formatted("%3u/%-3zu %5.1f %5.1f", survival.recovered, survival.wrong_bits.size(),
                100 * survival.median_wrong_bits(), 100 * survival.worst_wrong_bits());
  if (survival.recovered == 0) return cell;
  return cell + formatted("  2^%.0f", std::ceil(std::log2(survival.worst_false_alarm)));
}

struct DistortionRow {
  const char* name;
  double (*value)(const MarkDistortion& distortion);
};
constexpr std::array<DistortionRow, 5> kDistortions = {
    {{"MRMS, % of diagonal", [](const MarkDistortion& d) { return 100 * d.mrms_rel_diag; }},
     {"Hausdorff, %", [](const MarkDistortion& d) { return 100 * d.hausdorff_rel_diag; }},
     {"MSDM2", [](const MarkDistortion& d) { return d.msdm2; }},
     {"normals, mean degrees", [](const MarkDistortion& d) { return d.normal_mean_degrees; }},
     {"normals, most degrees", [](const MarkDistortion& d) { return d.normal_max_degrees; }}}};

nlohmann::ordered_json json_of(const MarkDistortion& distortion) {
  return {{"mrms_rel_diag", distortion.mrms_rel_diag},
          {"hausdorff_rel_diag", distortion.hausdorff_rel_diag},
          {"msdm2", distortion.msdm2},
          {"normal_deviation_mean_degrees", distortion.normal_mean_degrees},
          {"normal_deviation_max_degrees", distortion.normal_max_degrees}};
}

nlohmann::ordered_json json_of(const AttackSurvival& survival) {
  nlohmann::ordered_json json = {{"attack", survival.attack},
                                 {"tried", survival.wrong_bits.size()},
                                 {"recovered", survival.recovered}};
  if (survival.not_applied > 0) json["not_applied"] = survival.not_applied;
  if (survival.wrong_bits.empty()) return json;
  json["wrong_bits_median"] = survival.median_wrong_bits();
  json["wrong_bits_worst"] = survival.worst_wrong_bits();
  if (survival.recovered > 0) json["false_alarm_worst"] = survival.worst_false_alarm;
  return json;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == text.npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string csv_number(double value) {
  return to_text(OptionValue(value));
}

}  // namespace

void print_survival(std::ostream& out, const SurvivalBlock& block) {
  const std::size_t schemes = block.schemes.size();
  std::vector<std::string> cells(schemes);
  out << (block.mesh.empty() ? "all meshes" : printable(block.mesh.string())) << ": "
      << block.points << " points, " << block.triangles << " triangles\n";
  print_row(out, "", block.schemes);
  print_row(out, "attack", std::vector<std::string>(schemes, "   read  wrong bits %  alarm"));
  for (std::size_t a = 0; a < block.results.front().attacks.size(); ++a) {
    for (std::size_t s = 0; s < schemes; ++s) cells[s] = cell_of(block.results[s].attacks[a]);
    print_row(out, block.results.front().attacks[a].attack, cells);
  }
  for (std::size_t s = 0; s < schemes; ++s) {
    const SchemeSurvival& result = block.results[s];
    cells[s] = formatted("%3u/%-3u", result.marked, result.meshes_tried);
  }
  print_row(out, "marked", cells);
  for (const DistortionRow& row : kDistortions) {
    for (std::size_t s = 0; s < schemes; ++s) {
      const SchemeSurvival& result = block.results[s];
      cells[s] = result.marked > 0 ? formatted("   %.3g", row.value(result.distortion)) : "   -";
    }
    print_row(out, row.name, cells);
  }
  for (std::size_t s = 0; s < schemes; ++s) {
    const std::string& refusal = block.results[s].refusal;
    if (!refusal.empty()) out << block.schemes[s] << ": " << printable(refusal) << "\n";
  }
}

std::string survival_json(const SurvivalBlock& block) {
  std::string lines;
  for (std::size_t s = 0; s < block.schemes.size(); ++s) {
    const SchemeSurvival& result = block.results[s];
    nlohmann::ordered_json json;
    put_path(json, "mesh", block.mesh);
    json["points"] = block.points;
    json["triangles"] = block.triangles;
    json["scheme"] = block.schemes[s];
    json["tried"] = result.meshes_tried;
    json["marked"] = result.marked;
    if (!result.refusal.empty()) json["refusal"] = result.refusal;
    if (result.marked > 0) json["distortion"] = json_of(result.distortion);
    json["attacks"] = nlohmann::ordered_json::array();
    for (const AttackSurvival& survival : result.attacks) {
      json["attacks"].push_back(json_of(survival));
    }
    lines += to_line(json);
  }
  return lines;
}

std::string survival_csv_heading() {
  return "mesh,scheme,attack,tried,recovered,wrong_bits_median,wrong_bits_worst,"
         "false_alarm_worst,mrms_rel_diag,hausdorff_rel_diag,msdm2,"
         "normal_deviation_mean_degrees,normal_deviation_max_degrees\n";
}

std::string survival_csv(const SurvivalBlock& block) {
  std::string rows;
  for (std::size_t s = 0; s < block.schemes.size(); ++s) {
    const SchemeSurvival& result = block.results[s];
    const MarkDistortion& d = result.distortion;
    for (const AttackSurvival& survival : result.attacks) {
      const bool is_tried = !survival.wrong_bits.empty();
      rows += csv_field(block.mesh.string()) + "," + csv_field(block.schemes[s]) + "," +
              survival.attack + "," + std::to_string(survival.wrong_bits.size()) + "," +
              std::to_string(survival.recovered) + "," +
              (is_tried ? csv_number(survival.median_wrong_bits()) : "") + "," +
              (is_tried ? csv_number(survival.worst_wrong_bits()) : "") + "," +
              (survival.recovered > 0 ? csv_number(survival.worst_false_alarm) : "");
      for (const double value : {d.mrms_rel_diag, d.hausdorff_rel_diag, d.msdm2,
                                 d.normal_mean_degrees, d.normal_max_degrees}) {
        rows += "," + (result.marked > 0 ? csv_number(value) : "");
      }
      rows += "\n";
    }
  }
  return rows;
}

}  // namespace triglyph
