#include "cli/options.h"

#include <iostream>

namespace triglyph {

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
      ->check(CLI::IsMember({"tsq"}))
      ->capture_default_str();
  verb.add_option("--marker-bits", format_.marker_bits, "Bits of the marker, m")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  verb.add_option("--subscript-bits", format_.subscript_bits,
                  "Bits of the subscript, s; --fill chooses its own")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  verb.add_option("--part-bits", format_.part_bits, "Bits of the message in a unit, w")
      ->check(CLI::Range(2, 32))
      ->capture_default_str();
  verb.add_option("--step", step_,
                  "Width of a quantiser cell, dimensionless [0.03, with --fill 0.004]")
      ->check(CLI::Range(1e-6, 0.5));
}

void SchemeArguments::apply_to(JobSettings& settings) const {
  settings.options.scheme = scheme_;
  settings.options.format = format_;
  if (step_ > 0) settings.step = step_;
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
