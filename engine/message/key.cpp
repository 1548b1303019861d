#include "engine/message/key.h"

#include <cerrno>
#include <cstring>
#include <sstream>

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace triglyph {
namespace {

constexpr char kContext[crypto_kdf_CONTEXTBYTES + 1] = "triglyph";
constexpr std::string_view kHeading = "triglyph key 1";
constexpr std::string_view kTrialSeed = "triglyph public trial key";

void start_sodium() {
  check(sodium_init() >= 0, "libsodium cannot be initialised");
}

template <std::size_t N>
std::array<std::uint8_t, N> hash(std::span<const std::uint8_t> bytes,
                                 std::span<const std::uint8_t> key = {}) {
  std::array<std::uint8_t, N> digest;
  crypto_generichash(digest.data(), N, bytes.data(), bytes.size(),
                     key.empty() ? nullptr : key.data(), key.size());
  return digest;
}

// Returns eight hexadecimal digits that reveal a mistyped or truncated key file.
std::string check_digits(std::span<const std::uint8_t> secret) {
  return to_hex(hash<crypto_generichash_BYTES_MIN>(secret)).substr(0, 8);
}

// A file descriptor that is closed on destruction.
struct Descriptor {
  int fd = -1;
  ~Descriptor() {
    if (fd >= 0) close(fd);
  }
};

std::string read_private_file(const std::filesystem::path& path) {
  const Descriptor file{open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)};
  if (file.fd < 0) {
    throw Error(ErrorCode::Unreadable, path, "",
                errno == ELOOP ? std::string("key file is a symbolic link") : system_reason(errno));
  }
  struct stat status {};
  if (fstat(file.fd, &status) != 0 || !S_ISREG(status.st_mode)) {
    throw Error(ErrorCode::Unreadable, path, "", "key file is not a regular file");
  }
  if ((status.st_mode & 077) != 0) {
    throw Error(ErrorCode::Unreadable, path, "",
                "key file is open to group or others; run chmod 600 on it");
  }
  std::string text(256, '\0');
  const ssize_t count = read(file.fd, text.data(), text.size());
  if (count < 0) throw Error(ErrorCode::Unreadable, path, "", system_reason(errno));
  text.resize(static_cast<std::size_t>(count));
  return text;
}

}  // namespace

Key Key::trial() {
  return trial(0);
}

Key Key::trial(std::uint64_t number) {
  start_sodium();
  std::string seed(kTrialSeed);
  if (number > 0) seed += ' ' + std::to_string(number);
  Key key;
  key.secret_ = hash<kBytes>({reinterpret_cast<const std::uint8_t*>(seed.data()), seed.size()});
  return key;
}

Key Key::generate() {
  start_sodium();
  Key key;
  randombytes_buf(key.secret_.data(), key.secret_.size());
  return key;
}

Key Key::load(const std::filesystem::path& path) {
  start_sodium();
  std::istringstream text(read_private_file(path));
  std::string heading, secret_word, secret, check_word, digits;
  std::getline(text, heading);
  text >> secret_word >> secret >> check_word >> digits;
  if (heading != kHeading || secret_word != "secret" || check_word != "check") {
    throw Error(ErrorCode::Malformed, path, at_line(1), "not a triglyph key file");
  }
  Key key;
  try {
    const std::vector<std::uint8_t> bytes = from_hex(secret);
    if (bytes.size() != kBytes) throw Error(ErrorCode::Malformed, path, at_line(2), "");
    std::copy(bytes.begin(), bytes.end(), key.secret_.begin());
  } catch (const Error&) {
    throw Error(ErrorCode::Malformed, path, at_line(2), "the secret is not 64 hexadecimal digits");
  }
  if (digits != check_digits(key.secret_)) {
    throw Error(ErrorCode::Malformed, path, at_line(3), "check digits do not fit the secret");
  }
  return key;
}

void Key::save(const std::filesystem::path& path) const {
  const Descriptor file{open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)};
  if (file.fd < 0) throw Error(ErrorCode::Unwritable, path, "", system_reason(errno));
  const std::string text = std::string(kHeading) + "\nsecret " + to_hex(secret_) + "\ncheck " +
                           check_digits(secret_) + "\n";
  if (write(file.fd, text.data(), text.size()) != static_cast<ssize_t>(text.size()) ||
      fsync(file.fd) != 0) {
    const std::string reason = system_reason(errno);
    unlink(path.c_str());
    throw Error(ErrorCode::Unwritable, path, "", reason);
  }
}

Key::~Key() {
  sodium_memzero(secret_.data(), secret_.size());
}

std::array<std::uint8_t, Key::kBytes> Key::derive(KeyUse use) const {
  std::array<std::uint8_t, kBytes> subkey;
  crypto_kdf_derive_from_key(subkey.data(), subkey.size(), static_cast<std::uint64_t>(use),
                             kContext, secret_.data());
  return subkey;
}

std::vector<std::uint8_t> Key::stream(KeyUse use, std::size_t count) const {
  const auto seed = derive(use);
  static_assert(kBytes == randombytes_SEEDBYTES);
  std::vector<std::uint8_t> bytes(count);
  if (count > 0) randombytes_buf_deterministic(bytes.data(), bytes.size(), seed.data());
  return bytes;
}

std::uint32_t Key::tag(std::span<const std::uint8_t> message) const {
  const auto digest = hash<crypto_generichash_BYTES_MIN>(message, derive(KeyUse::Tag));
  return std::uint32_t{digest[0]} | std::uint32_t{digest[1]} << 8 | std::uint32_t{digest[2]} << 16 |
         std::uint32_t{digest[3]} << 24;
}

std::uint64_t Key::number(std::span<const std::uint8_t> message) const {
  return keyed_number(message, KeyUse::FluxNumber);
}

std::uint64_t Key::copy_seed(std::span<const std::uint8_t> name) const {
  return keyed_number(name, KeyUse::CopySeed);
}

std::uint64_t Key::keyed_number(std::span<const std::uint8_t> bytes, KeyUse use) const {
  const auto digest = hash<crypto_generichash_BYTES_MIN>(bytes, derive(use));
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < sizeof(number); ++i) number |= std::uint64_t{digest[i]} << (8 * i);
  return number;
}

std::string Key::fingerprint() const {
  return to_hex(derive(KeyUse::Fingerprint)).substr(0, 16);
}

bool Key::is_trial() const {
  return secret_ == trial().secret_;
}

std::string to_hex(std::span<const std::uint8_t> bytes) {
  std::string text(2 * bytes.size() + 1, '\0');
  sodium_bin2hex(text.data(), text.size(), bytes.data(), bytes.size());
  text.pop_back();
  return text;
}

std::vector<std::uint8_t> from_hex(const std::string& text) {
  if (text.empty()) return {};  // the library takes no null pointer
  std::vector<std::uint8_t> bytes(text.size() / 2);
  std::size_t count = 0;
  const char* end = nullptr;
  if (text.size() % 2 != 0 ||
      sodium_hex2bin(bytes.data(), bytes.size(), text.data(), text.size(), nullptr, &count, &end) !=
          0 ||
      end != text.data() + text.size() || count != bytes.size()) {
    throw Error(ErrorCode::Usage, {}, "", "not an even number of hexadecimal digits");
  }
  return bytes;
}

std::string shown(std::span<const std::uint8_t> message) {
  const std::string text(message.begin(), message.end());
  return is_printable(text) ? '"' + text + '"' : "0x" + to_hex(message);
}

std::string content_hash(std::span<const char> bytes) {
  start_sodium();
  return to_hex(hash<crypto_generichash_BYTES>(
      {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
}

}  // namespace triglyph
