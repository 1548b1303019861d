// Declarations of options: key, range, unit, choices and help, and the member that holds the value.
// Command line, config files, manifests, records and help all read these declarations, so a value
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

// A value as users write it, in the unit that the option declares.
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
  std::string unit;                  // of Count and Number, in the plural ("bits"); empty: none
  OptionRange range;                 // of Count and Number
  std::vector<std::string> choices;  // of Choice
  std::string default_text;          // the default as help shows it; empty: none
  std::string help;                  // one line, a verb or noun phrase without a full stop

  // Returns "--max-move".
  [[nodiscard]] std::string flag() const;

  // Returns the allowed values in words, as error messages show them: "a whole number from 0 to 16
  // bits", "one of tsq, aie, iie".
  [[nodiscard]] std::string domain() const;

  // Returns the range and unit of a Count or Number in short form, as help shows them: "0 to 16
  // bits", "above 0 to 0.5". Empty for other kinds.
  [[nodiscard]] std::string range_text() const;

  // Returns the value converted to this option's kind; a Number also accepts whole numbers. Throws
  // Error Usage naming the key if the type is wrong or the value is out of range.
  [[nodiscard]] OptionValue checked(const OptionValue& value) const;

  // Parses a value from text, as on the command line. Throws Error Usage as checked() does.
  [[nodiscard]] OptionValue parsed(std::string_view text) const;
};

// Returns the value as text that parsed() reads back; numbers in the shortest such form.
[[nodiscard]] std::string to_text(const OptionValue& value);

// An option, with access to its value in `Settings`.
template <typename Settings>
struct Option {
  OptionSpec spec;
  std::function<void(Settings&, const OptionValue&)> set;  // takes a checked value
  // Returns nothing if the option is optional and has no value.
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

// Declares an option that is held in a plain or optional member and converted from Stored by
// static_cast.
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

// Declare an option that is held in a member of `Settings` or of its base class, plain or
// std::optional.
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

// Declares an option whose value is an enumeration, held in a plain or optional member. names[i] is
// the name of the enumerator with value i.
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

// Returns the option with this key, or null if there is none. O(options).
template <typename Settings>
[[nodiscard]] const Option<Settings>* find_option(const OptionTable<Settings>& table,
                                                  std::string_view key) {
  for (const Option<Settings>& option : table) {
    if (option.spec.key == key) return &option;
  }
  return nullptr;
}

// Sets the options whose keys occur in `values`; ignores keys that the table does not have. Throws
// Error Usage for a value of the wrong type or out of range.
template <typename Settings>
void apply_options(const OptionTable<Settings>& table, const OptionValues& values,
                   Settings& settings) {
  for (const Option<Settings>& option : table) {
    const auto found = values.find(option.spec.key);
    if (found != values.end()) option.set(settings, option.spec.checked(found->second));
  }
}

// Returns the values of all options that have one.
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
