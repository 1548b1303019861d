#include "engine/base/options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "engine/base/error.h"

namespace triglyph {
namespace {

// A bound from here on means that there is none: doubles do not represent every whole number
// beyond.
constexpr double kLargestCount = 9007199254740992.0;  // 2^53

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

bool is_finite_bound(double bound) {
  return std::abs(bound) < kLargestCount;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool lies_in(const OptionRange& range, double value) {
  return (range.above_least ? value > range.least : value >= range.least) && value <= range.most;
}

template <typename Number>
std::optional<Number> whole_text_as(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

std::string OptionSpec::flag() const {
  std::string name = "--" + key;
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::string OptionSpec::domain() const {
  switch (kind) {
    case OptionKind::Flag:
      return "true or false";
    case OptionKind::Text:
      return "text";
    case OptionKind::Choice:
      return "one of " + joined(choices);
    case OptionKind::Count:
    case OptionKind::Number:
      break;
  }
  const std::string_view preposition = range.above_least             ? " "
                                       : is_finite_bound(range.most) ? " from "
                                                                     : " of ";
  return (kind == OptionKind::Count ? "a whole number" : "a number") + std::string(preposition) +
         range_text();
}

std::string OptionSpec::range_text() const {
  if (kind != OptionKind::Count && kind != OptionKind::Number) return "";
  const auto bound_text = [&](double bound) {
    return kind == OptionKind::Count ? std::to_string(static_cast<std::int64_t>(bound))
                                     : shortest(bound);
  };
  const bool has_most = is_finite_bound(range.most);
  std::string text = range.above_least ? "above " : has_most ? "" : "at least ";
  text += bound_text(range.least);
  if (has_most) text += " to " + bound_text(range.most);
  return unit.empty() ? text : text + " " + unit;
}

OptionValue OptionSpec::checked(const OptionValue& value) const {
  const auto refuse = [&]() -> OptionValue {
    throw Error(ErrorCode::Usage, {}, "",
                "\"" + key + "\" must be " + domain() + ", not " + to_text(value));
  };
  switch (kind) {
    case OptionKind::Flag:
      return std::holds_alternative<bool>(value) ? value : refuse();
    case OptionKind::Text:
      return std::holds_alternative<std::string>(value) ? value : refuse();
    case OptionKind::Choice: {
      const auto* name = std::get_if<std::string>(&value);
      const bool known =
          name != nullptr && std::find(choices.begin(), choices.end(), *name) != choices.end();
      return known ? value : refuse();
    }
    case OptionKind::Count: {
      const auto* count = std::get_if<std::int64_t>(&value);
      const bool fits = count != nullptr && lies_in(range, static_cast<double>(*count));
      return fits ? value : refuse();
    }
    case OptionKind::Number: {
      const auto* count = std::get_if<std::int64_t>(&value);
      const auto* number = std::get_if<double>(&value);
      if (count == nullptr && number == nullptr) return refuse();
      const double real = number != nullptr ? *number : static_cast<double>(*count);
      return lies_in(range, real) ? OptionValue(real) : refuse();
    }
  }
  return refuse();
}

OptionValue OptionSpec::parsed(std::string_view text) const {
  const std::string copy(text);
  switch (kind) {
    case OptionKind::Flag:
      if (text == "true" || text == "false") return text == "true";
      return checked(copy);
    case OptionKind::Count:
      if (const auto count = whole_text_as<std::int64_t>(text)) return checked(*count);
      return checked(copy);
    case OptionKind::Number:
      if (const auto number = whole_text_as<double>(text)) return checked(*number);
      return checked(copy);
    case OptionKind::Choice:
    case OptionKind::Text:
      break;
  }
  return checked(copy);
}

std::string to_text(const OptionValue& value) {
  struct Writer {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t count) const { return std::to_string(count); }
    std::string operator()(double number) const { return shortest(number); }
    std::string operator()(const std::string& text) const { return text; }
  };
  return std::visit(Writer{}, value);
}

}  // namespace triglyph
