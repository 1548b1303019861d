// Options declared once: key, range, unit, choices and help of each, and where its value is kept.
// Command line, config files, manifests, records and help all read these declarations; a value
// means the same in each of them.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace triglyph {

// A value as it is written down: in the units that the option declares.
using OptionValue = std::variant<bool, std::int64_t, double, std::string>;

// Values by key.
using OptionValues = std::map<std::string, OptionValue, std::less<>>;

enum class OptionKind {
  Flag,    // true or false
  Count,   // a whole number
  Number,  // a real number
  Choice,  // one of several names
  Text,
};

struct OptionRange {
  double least = 0;
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;  // the least value itself is excluded
};

struct OptionSpec {
  std::string key;  // "max_move" in manifests, config files and records
  OptionKind kind = OptionKind::Text;
  std::string unit;                  // of a number; empty: none
  OptionRange range;                 // of counts and numbers
  std::vector<std::string> choices;  // of a choice
  std::string default_text;          // what applies if the user says nothing
  std::string help;                  // one line, a verb or noun phrase without a full stop

  // Returns "--max-move".
  [[nodiscard]] std::string flag() const;

  // Returns the type, range or choices in words: "0 to 100 percent of the diagonal".
  [[nodiscard]] std::string domain() const;

  // Returns the value as this option's kind: a whole number also serves as a real one. Throws
  // Error Usage naming the key for another type or a value outside the range.
  [[nodiscard]] OptionValue checked(const OptionValue& value) const;

  // Reads the value from text, as on the command line. Throws Error Usage as checked() does.
  [[nodiscard]] OptionValue parsed(std::string_view text) const;
};

// Returns the value as text, which parsed() reads back; numbers in the shortest form.
[[nodiscard]] std::string to_text(const OptionValue& value);

// An option and its place in `Settings`.
template <typename Settings>
struct Option {
  OptionSpec spec;
  std::function<void(Settings&, const OptionValue&)> set;  // of a checked value
  // Returns nothing where no value was chosen and another place decides.
  std::function<std::optional<OptionValue>(const Settings&)> get;
};

template <typename Settings>
using OptionTable = std::vector<Option<Settings>>;

namespace detail {

template <typename T>
struct Unwrapped {
  using type = T;
};
template <typename T>
struct Unwrapped<std::optional<T>> {
  using type = T;
};

// An option kept in a plain or optional member, converted from Stored by the cast.
template <typename Settings, typename Base, typename Member, typename Stored>
Option<Settings> member_option(OptionSpec spec, Member Base::*member, Stored) {
  using Value = typename Unwrapped<Member>::type;
  return {std::move(spec),
          [member](Settings& settings, const OptionValue& value) {
            settings.*member = static_cast<Value>(std::get<Stored>(value));
          },
          [member](const Settings& settings) -> std::optional<OptionValue> {
            if constexpr (std::is_same_v<Member, Value>) {
              return OptionValue(static_cast<Stored>(settings.*member));
            } else {
              if (!(settings.*member)) return std::nullopt;
              return OptionValue(static_cast<Stored>(*(settings.*member)));
            }
          }};
}

}  // namespace detail

// Options kept in a member of `Settings` or of its base, plain or std::optional.
template <typename Settings, typename Base, typename Member>
[[nodiscard]] Option<Settings> flag_option(std::string key, Member Base::*member,
                                           std::string help) {
  return detail::member_option<Settings>(
      {std::move(key), OptionKind::Flag, "", {}, {}, "", std::move(help)}, member, bool{});
}
template <typename Settings, typename Base, typename Member>
[[nodiscard]] Option<Settings> count_option(std::string key, Member Base::*member,
                                            OptionRange range, std::string unit,
                                            std::string default_text, std::string help) {
  return detail::member_option<Settings>({std::move(key),
                                          OptionKind::Count,
                                          std::move(unit),
                                          range,
                                          {},
                                          std::move(default_text),
                                          std::move(help)},
                                         member, std::int64_t{});
}
template <typename Settings, typename Base, typename Member>
[[nodiscard]] Option<Settings> number_option(std::string key, Member Base::*member,
                                             OptionRange range, std::string unit,
                                             std::string default_text, std::string help) {
  return detail::member_option<Settings>({std::move(key),
                                          OptionKind::Number,
                                          std::move(unit),
                                          range,
                                          {},
                                          std::move(default_text),
                                          std::move(help)},
                                         member, double{});
}

// An option whose value is an enumeration, kept in a plain or optional member: entry i of `names`
// is the name of the enumerator with value i.
template <typename Settings, typename Base, typename Member>
[[nodiscard]] Option<Settings> choice_option(std::string key, Member Base::*member,
                                             std::span<const std::string_view> names,
                                             std::string default_text, std::string help) {
  using Value = typename detail::Unwrapped<Member>::type;
  OptionSpec spec{std::move(key),          OptionKind::Choice, "", {}, {names.begin(), names.end()},
                  std::move(default_text), std::move(help)};
  return {std::move(spec),
          [member, names](Settings& settings, const OptionValue& value) {
            const auto& name = std::get<std::string>(value);
            for (std::size_t i = 0; i < names.size(); ++i) {
              if (names[i] == name) settings.*member = static_cast<Value>(i);
            }
          },
          [member, names](const Settings& settings) -> std::optional<OptionValue> {
            if constexpr (std::is_same_v<Member, Value>) {
              return OptionValue(std::string(names[static_cast<std::size_t>(settings.*member)]));
            } else {
              if (!(settings.*member)) return std::nullopt;
              return OptionValue(std::string(names[static_cast<std::size_t>(*(settings.*member))]));
            }
          }};
}

// Returns the option with this key, or null. O(options).
template <typename Settings>
[[nodiscard]] const Option<Settings>* find_option(const OptionTable<Settings>& table,
                                                  std::string_view key) {
  for (const Option<Settings>& option : table) {
    if (option.spec.key == key) return &option;
  }
  return nullptr;
}

// Applies the values whose keys the table has. Throws Error Usage for a value that is out of range.
template <typename Settings>
void apply_options(const OptionTable<Settings>& table, const OptionValues& values,
                   Settings& settings) {
  for (const Option<Settings>& option : table) {
    const auto found = values.find(option.spec.key);
    if (found != values.end()) option.set(settings, option.spec.checked(found->second));
  }
}

// Returns the values that the settings hold, by key.
template <typename Settings>
[[nodiscard]] OptionValues option_values(const OptionTable<Settings>& table,
                                         const Settings& settings) {
  OptionValues values;
  for (const Option<Settings>& option : table) {
    if (std::optional<OptionValue> value = option.get(settings)) {
      values.emplace(option.spec.key, std::move(*value));
    }
  }
  return values;
}

}  // namespace triglyph
