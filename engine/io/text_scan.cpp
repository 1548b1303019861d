#include "engine/io/text_scan.h"

#include <algorithm>
#include <cstring>

#include "engine/base/error.h"

namespace triglyph {

TextScan::TextScan(const Source& source)
    : source_(source), p_(source.bytes.data()), end_(source.bytes.data() + source.bytes.size()) {
  const std::string_view text(source.bytes.data(), source.bytes.size());
  if (text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE")) {
    throw Error(ErrorCode::Unsupported, source.path, at_byte(0),
                "text in UTF-16 (only ASCII and UTF-8 are read)");
  }
  if (text.starts_with(kByteOrderMark)) p_ += kByteOrderMark.size();
  has_carriage_returns_ = text.find('\r') != std::string_view::npos;
}

void TextScan::skip_line() noexcept {
  if (p_ == end_) return;
  const void* feed = *p_ == '\n' ? p_ : std::memchr(p_, '\n', bytes_left());
  const char* stop = feed == nullptr ? end_ : static_cast<const char*>(feed);
  if (has_carriage_returns_) {
    const void* back = std::memchr(p_, '\r', static_cast<std::size_t>(stop - p_));
    if (back != nullptr) stop = static_cast<const char*>(back);
  }
  p_ = stop == end_ ? end_ : behind_line_end(stop);
}

const char* TextScan::behind_line_end(const char* position) const noexcept {
  if (position == end_ || !is_line_end(*position)) return nullptr;
  const bool is_pair = *position == '\r' && end_ - position > 1 && position[1] == '\n';
  return position + (is_pair ? 2 : 1);
}

void TextScan::skip_space(bool comments) noexcept {
  while (p_ != end_) {
    if (*p_ == ' ' || (*p_ >= '\t' && *p_ <= '\r')) {
      ++p_;
    } else if (comments && *p_ == '#') {
      skip_line();
    } else {
      return;
    }
  }
}

std::string_view TextScan::take_token() noexcept {
  const char* begin = p_;
  while (p_ != end_ && *p_ != ' ' && (*p_ < '\t' || *p_ > '\r')) ++p_;
  return {begin, static_cast<std::size_t>(p_ - begin)};
}

std::int64_t TextScan::take_integer(std::string_view what, std::int64_t low, std::int64_t high) {
  const char* p = p_;
  const bool negative = p != end_ && *p == '-';
  if (p != end_ && (*p == '-' || *p == '+')) ++p;
  const char* digits = p;
  std::int64_t value = 0;
  constexpr std::int64_t kSaturated = std::int64_t{1} << 56;
  for (; p != end_ && *p >= '0' && *p <= '9'; ++p)
    value = std::min(value * 10 + (*p - '0'), kSaturated);
  if (negative) value = -value;
  if (p == digits || (p != end_ && !is_separator(*p))) {
    fail_at("expected " + std::string(what));
  }
  if (value < low || value > high) {
    fail_at(std::string(what) + " is not in " + std::to_string(low) + ".." + std::to_string(high));
  }
  p_ = p;
  return value;
}

void TextScan::fail(const std::string& message) const {
  std::size_t lines = 0;
  for (const char* p = source_.bytes.data(); p < p_; ++p) {
    // A pair counts at its line feed.
    lines += *p == '\n' || (*p == '\r' && (p + 1 == end_ || p[1] != '\n'));
  }
  throw Error(ErrorCode::Malformed, source_.path, at_line(lines + 1), message);
}

void TextScan::fail_at(const std::string& message) const {
  fail(message + ", found " + show_token(p_, end_));
}

void TextScan::fail_number() const {
  fail_at("expected a finite number");
}

TokenPlace place_of(const TextScan& scan, const char* x, const char* y, const char* z) {
  const std::ptrdiff_t to_y = y - x, to_z = z - x;
  constexpr std::ptrdiff_t kMax = std::numeric_limits<std::int32_t>::max();
  if (std::max(std::abs(to_y), std::abs(to_z)) > kMax) {
    scan.fail("coordinates of one vertex lie more than 2 GiB apart");
  }
  return {scan.offset(x), static_cast<std::int32_t>(to_y), static_cast<std::int32_t>(to_z)};
}

}  // namespace triglyph
