#include "cli/options.h"

#include <iostream>

namespace triglyph {

std::vector<std::string> strings(std::span<const std::string_view> names) {
  return {names.begin(), names.end()};
}

void KeyArgument::add_to(CLI::App& verb) {
  verb.add_option("--key-file", file_, "Secret key made by keygen; a public trial key without it")
      ->type_name("FILE");
}

Key KeyArgument::load() const {
  if (!file_.empty()) return Key::load(file_);
  std::cerr << "triglyph: warning: no --key-file, using the public trial key that anyone can read "
               "and forge\n";
  return Key::trial();
}

void SchemeArguments::add_to(CLI::App& verb) {
  verb.add_option("--scheme", scheme_, "Embedding scheme")
      ->check(CLI::IsMember(strings(scheme_names())))
      ->capture_default_str();
  verb.add_option("--marker-bits", marker_bits_, "Bits of the marker, m [the scheme's]")
      ->check(CLI::Range(0, 16));
  verb.add_option("--subscript-bits", subscript_bits_,
                  "Bits of the subscript, s; with --fill as few as needed [the scheme's]")
      ->check(CLI::Range(1, 16));
  verb.add_option("--part-bits", part_bits_, "Bits of the message in a unit, w [the scheme's]")
      ->check(CLI::Range(2, 32));
  verb.add_option("--step", step_, "Width of a quantiser cell, dimensionless [the scheme's]")
      ->check(CLI::PositiveNumber);
  verb.add_option("--radius-edges", radius_edges_,
                  "Radius of the balls of iie in mean edge lengths [the scheme's]")
      ->check(CLI::Range(2.0, 100.0));
  verb.add_option("--radius", radius_, "The same in model units; then scaling is not survived")
      ->check(CLI::PositiveNumber);
  verb.add_option("--site-rings", site_rings_,
                  "Rings within which one point may be a centre of iie; 0: all [the scheme's]")
      ->check(CLI::Range(0, 8));
  verb.add_option("--aie-groups", groups_, "Neighbours that carry a group's bits in aie")
      ->check(CLI::IsMember({"one", "all"}))
      ->capture_default_str();
}

void SchemeArguments::apply_to(JobSettings& settings) const {
  settings.scheme = scheme_;
  settings.marker_bits = marker_bits_;
  settings.subscript_bits = subscript_bits_;
  settings.part_bits = part_bits_;
  settings.step = step_;
  settings.groups = aie_groups(groups_);
  settings.radius_edges = radius_edges_;
  settings.radius = radius_;
  settings.site_rings = site_rings_;
}

void MachineArguments::add_threads_to(CLI::App& verb) {
  verb.add_option("--threads", threads_, "Threads to use [all]")->check(CLI::Range(1, 1024));
}

void MachineArguments::add_memory_to(CLI::App& verb) {
  verb.add_option("--memory", memory_,
                  "Memory for meshes in work, such as 4G; a larger mesh goes alone")
      ->transform(CLI::AsSizeValue(false))
      ->default_str("4G");
}

}  // namespace triglyph
