#include <iostream>

#include "cli/app.h"
#include "cli/verbs.h"
#include "engine/message/key.h"

namespace triglyph {

void add_keygen_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("keygen", "Generate a secret key");
  auto out = std::make_shared<std::filesystem::path>();
  verb->add_option("--out", *out, "Key file to create, with mode 0600; must not exist")
      ->required()
      ->type_name("FILE");
  verb->footer(
      "Make the key of an owner; whoever has it can read and forge the owner's marks:\n"
      "  triglyph keygen --out owner.key");
  verb->callback([&action, out] {
    action = [out] {
      const Key key = Key::generate();
      key.save(*out);
      std::cout << "key " << key.fingerprint() << " written to " << out->string() << "\n";
      return kDone;
    };
  });
}

}  // namespace triglyph
