// triglyph_tables [--json FILE] [--csv FILE] [--slow] MESH...: marks every mesh under every scheme
// with and without each step of the optimisation, under the same key and bit plan (--fill), and
// prints the tables of Wang & Hu, CAGD 27 (2010). A mesh named bunny, armadillo or max-planck gets
// the paper's figures beside it. --slow adds the Hausdorff cost for tsq, minutes a mesh.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/marking/mark_file.h"
#include "engine/scheme/registry.h"
#include "manifests/json_line.h"
#include "manifests/record.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

struct Variant {
  const char* name;
  LayoutMethod layout;
  AssignMethod assign;
  CostFunction cost = CostFunction::Displacement;
  double drop_dearest_percent = 0;
};

constexpr Variant kPlain{"un-optimised", LayoutMethod::FirstFit, AssignMethod::Sequential};
constexpr Variant kOptimised{"both steps", LayoutMethod::MinDegree, AssignMethod::Bottleneck};
constexpr LayoutMethod kGreedy = LayoutMethod::MinDegree;
constexpr AssignMethod kBottleneck = AssignMethod::Bottleneck;

std::vector<Variant> variants(bool slow_hausdorff) {
  std::vector<Variant> all = {
      kPlain,
      {"step 1 alone", kGreedy, AssignMethod::Sequential},
      {"step 2 alone", LayoutMethod::FirstFit, kBottleneck},
      kOptimised,
      {"least sum", kGreedy, AssignMethod::Sum},
      {"local search", LayoutMethod::LocalSearch, kBottleneck},
      {"cost rms", kGreedy, kBottleneck, CostFunction::Rms},
      {"cost rms, sum", kGreedy, AssignMethod::Sum, CostFunction::Rms},
      {"cost normal", kGreedy, kBottleneck, CostFunction::Normal},
      {"5 % left out", kGreedy, kBottleneck, CostFunction::Displacement, 5},
      {"20 % left out", kGreedy, kBottleneck, CostFunction::Displacement, 20},
      {"40 % left out", kGreedy, kBottleneck, CostFunction::Displacement, 40},
      {"60 % left out", kGreedy, kBottleneck, CostFunction::Displacement, 60},
  };
  if (slow_hausdorff)
    all.push_back({"cost hausdorff", kGreedy, kBottleneck, CostFunction::Hausdorff});
  return all;
}

// Valid units before and after, and the fall of the Hausdorff distance in percent.
struct PaperRow {
  const char* model;
  const char* scheme;
  int units, optimised_units;
  double fall;
};
constexpr PaperRow kPaper[] = {
    {"max-planck", "tsq", 593, 1702, 22.7}, {"armadillo", "tsq", 1124, 3462, 51.1},
    {"bunny", "tsq", 1741, 5337, 47.7},     {"max-planck", "aie", 815, 1049, 14.3},
    {"armadillo", "aie", 1710, 2232, 22.6}, {"bunny", "aie", 2876, 3444, 28.3},
    {"max-planck", "iie", 129, 140, 7.4},   {"armadillo", "iie", 208, 287, 19.9},
    {"bunny", "iie", 331, 424, 12.4},
};

struct Row {
  std::string mesh, scheme, variant;
  MarkedFile record;
};

MarkedFile mark_once(const fs::path& mesh, const OptionValues& values, const fs::path& out) {
  MarkedFile result = mark_file(mesh, out / mesh.filename(), resolve(values), Key::trial());
  fs::remove_all(out);
  if (!result.is_marked()) std::fprintf(stderr, "note: %s\n", result.error.c_str());
  return result;
}

OptionValues values_of(const std::string& scheme, const Variant& variant) {
  return {{"fill", true},
          {"scheme", scheme},
          {"layout", std::string(name_of(variant.layout))},
          {"assign", std::string(name_of(variant.assign))},
          {"cost", std::string(name_of(variant.cost))},
          {"drop_dearest", variant.drop_dearest_percent}};
}

std::vector<Row> run_all(const fs::path& mesh, const std::string& scheme, bool slow) {
  const fs::path out = fs::temp_directory_path() / "triglyph-tables";
  // the optimised mark has the most units and so sets the bit plan for all
  const MarkedFile first = mark_once(mesh, values_of(scheme, kOptimised), out);
  std::vector<Row> rows;
  for (const Variant& variant : variants(slow || scheme != "tsq")) {
    OptionValues values = values_of(scheme, variant);
    values["subscript_bits"] = std::int64_t{first.format.subscript_bits};
    rows.push_back({mesh.stem().string(), scheme, variant.name, mark_once(mesh, values, out)});
  }
  return rows;
}

double percent(double share) {
  return 100 * share;
}

void print_variants(const std::vector<Row>& rows) {
  std::printf("\n%s, %s, %llu points, no layout has more than %u units\n", rows[0].mesh.c_str(),
              rows[0].scheme.c_str(), static_cast<unsigned long long>(rows[0].record.points),
              rows[0].record.units_bound);
  std::printf("%-16s %7s %8s %11s %11s %9s %9s\n", "", "valid", "embedded", "Hausdorff", "farthest",
              "step 1", "step 2");
  for (const Row& row : rows) {
    const MarkedFile& r = row.record;
    const double diagonal = r.hausdorff_rel_diag > 0 ? r.hausdorff / r.hausdorff_rel_diag : 0;
    std::printf("%-16s %7u %8u %9.4f %% %9.4f %% %7.3f s %7.3f s\n", row.variant.c_str(),
                r.units_valid, r.units_embedded, percent(r.hausdorff_rel_diag),
                diagonal > 0 ? percent(r.displacement_max / diagonal) : 0, r.times.layout,
                r.times.assign);
  }
}

const Row& named(const std::vector<Row>& rows, const std::string& variant) {
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const Row& row) { return row.variant == variant; });
}

// One line of the paper's tables, counting valid units or embedded ones.
void print_paper_line(const std::vector<Row>& rows, bool embedded) {
  const MarkedFile& plain = named(rows, kPlain.name).record;
  const MarkedFile& best = named(rows, kOptimised.name).record;
  const double units = embedded ? plain.units_embedded : plain.units_valid;
  const double more = embedded ? best.units_embedded : best.units_valid;
  std::printf("%-11s %-4s %-9s %6.0f %6.0f %6.1f %% %7.3f s %8.4f %% %8.4f %% %6.1f %% %7.3f s",
              rows[0].mesh.c_str(), rows[0].scheme.c_str(), embedded ? "embedded" : "valid", units,
              more, percent(more / units - 1), best.times.layout, percent(plain.hausdorff_rel_diag),
              percent(best.hausdorff_rel_diag), percent(1 - best.hausdorff / plain.hausdorff),
              best.times.assign);
  for (const PaperRow& paper : kPaper) {
    if (embedded || paper.model != rows[0].mesh || paper.scheme != rows[0].scheme) continue;
    std::printf("   %d -> %d, %.1f %%", paper.units, paper.optimised_units, paper.fall);
  }
  std::printf("\n");
}

void print_paper_table(const std::vector<std::vector<Row>>& runs) {
  std::printf("\n%-11s %-4s %-9s %6s %6s %8s %9s %10s %10s %8s %9s   paper\n", "", "", "", "No.",
              "Opt", "more", "step 1", "Dis", "Opt Dis", "less", "step 2");
  for (const auto& rows : runs) {
    print_paper_line(rows, false);
    print_paper_line(rows, true);
  }
}

void write_csv(const std::vector<std::vector<Row>>& runs, const fs::path& path) {
  std::ofstream file(path);
  file << "mesh,scheme,variant,points,candidates,units_bound,units_valid,units_embedded,hausdorff,"
          "hausdorff_rel_diag,displacement_max,cost_max,cost_sum,layout_s,assign_s\n";
  for (const auto& rows : runs) {
    for (const Row& row : rows) {
      const MarkedFile& r = row.record;
      file << row.mesh << ',' << row.scheme << ",\"" << row.variant << "\"," << r.points << ','
           << r.candidates << ',' << r.units_bound << ',' << r.units_valid << ','
           << r.units_embedded << ',' << r.hausdorff << ',' << r.hausdorff_rel_diag << ','
           << r.displacement_max << ',' << r.cost_max << ',' << r.cost_sum << ',' << r.times.layout
           << ',' << r.times.assign << '\n';
    }
  }
  if (!file.flush()) throw Error(ErrorCode::Unwritable, path, "", "the table cannot be written");
}

void write_json(const std::vector<std::vector<Row>>& runs, const fs::path& path) {
  std::ofstream file(path);
  for (const auto& rows : runs) {
    for (const Row& row : rows) {
      nlohmann::ordered_json json = {{"variant", row.variant}};
      json.update(to_json(Record{.file = row.record}));
      file << to_line(json);
    }
  }
  if (!file.flush()) throw Error(ErrorCode::Unwritable, path, "", "the records cannot be written");
}

struct Arguments {
  std::vector<fs::path> meshes;
  fs::path json, csv;
  bool slow = false;
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--slow") {
      arguments.slow = true;
    } else if ((word == "--json" || word == "--csv") && i + 1 < argc) {
      (word == "--json" ? arguments.json : arguments.csv) = argv[++i];
    } else {
      arguments.meshes.emplace_back(word);
    }
  }
  return arguments;
}

int run(const Arguments& arguments) {
  if (arguments.meshes.empty()) {
    std::fprintf(stderr, "usage: triglyph_tables [--json FILE] [--csv FILE] [--slow] MESH...\n");
    return 2;
  }
  std::vector<std::vector<Row>> runs;
  for (const fs::path& mesh : arguments.meshes) {
    for (const std::string_view scheme : scheme_names()) {
      runs.push_back(run_all(mesh, std::string(scheme), arguments.slow));
      print_variants(runs.back());
      std::fflush(stdout);
    }
  }
  print_paper_table(runs);
  if (!arguments.csv.empty()) write_csv(runs, arguments.csv);
  if (!arguments.json.empty()) write_json(runs, arguments.json);
  return 0;
}

}  // namespace
}  // namespace triglyph

int main(int argc, char** argv) try {
  return triglyph::run(triglyph::parse(argc, argv));
} catch (const triglyph::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
