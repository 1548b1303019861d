#include "render/picture_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "render/colours.h"

namespace triglyph {
namespace {

constexpr const char* kFont = "DejaVuSans";
constexpr int kSmallestText = 9;

bool is_jpeg(const std::string& extension) {
  return extension == ".jpg" || extension == ".jpeg";
}

std::uint8_t byte_of(float share) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0F, 1.0F) * 255.0F));
}

// Returns 8 bits per channel, not premultiplied, as PNG stores them.
std::vector<std::uint8_t> bytes_of(const Image& picture, bool with_alpha) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(picture.pixels().size() * 4);
  for (const Colour& pixel : picture.pixels()) {
    Colour shown = with_alpha ? pixel : over(pixel, Colour{1, 1, 1, 1});
    const float whole = shown.alpha > 0 ? 1 / shown.alpha : 0;
    for (const float channel : {shown.red, shown.green, shown.blue}) {
      bytes.push_back(byte_of(encode_srgb(channel * whole)));
    }
    if (with_alpha) bytes.push_back(byte_of(shown.alpha));
  }
  return bytes;
}

// Returns the bytes of the picture file.
std::vector<unsigned char> encode(const Image& picture, const std::filesystem::path& path) {
  const std::string extension = lower_case_ending(path);
  const bool is_exr = extension == ".exr";
  const bool with_alpha = !is_jpeg(extension);
  const auto output = OIIO::ImageOutput::create(extension.substr(1));
  if (!output) throw Error(ErrorCode::Unsupported, path, "", OIIO::geterror());
  OIIO::ImageSpec spec(picture.width(), picture.height(), with_alpha ? 4 : 3,
                       is_exr ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::UINT8);
  if (with_alpha) spec.alpha_channel = 3;
  spec.attribute("oiio:ColorSpace", is_exr ? "Linear" : "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", is_exr ? 0 : 1);
  spec.attribute("Compression", is_exr ? "zip" : "jpeg:92");
  OIIO::Filesystem::IOVecOutput memory;
  if (!output->set_ioproxy(&memory) || !output->open(path.string(), spec)) {
    throw Error(ErrorCode::Unsupported, path, "", output->geterror());
  }
  const bool written =
      is_exr ? output->write_image(OIIO::TypeDesc::FLOAT, picture.pixels().data())
             : output->write_image(OIIO::TypeDesc::UINT8, bytes_of(picture, with_alpha).data());
  if (!written || !output->close()) {
    throw Error(ErrorCode::Unwritable, path, "", output->geterror());
  }
  return memory.buffer();
}

OIIO::ImageBufAlgo::TextAlignX align_of(TextAnchor anchor) {
  switch (anchor) {
    case TextAnchor::Left:
      return OIIO::ImageBufAlgo::TextAlignX::Left;
    case TextAnchor::Middle:
      return OIIO::ImageBufAlgo::TextAlignX::Center;
    case TextAnchor::Right:
      return OIIO::ImageBufAlgo::TextAlignX::Right;
  }
  return OIIO::ImageBufAlgo::TextAlignX::Left;
}

}  // namespace

void draw_text(const std::string& text, int x, int y, const TextStyle& style, Image& picture) {
  int size = style.size;
  const auto width_at = [&](int pixels) {
    return OIIO::ImageBufAlgo::text_size(text, pixels, kFont).width();
  };
  while (size > kSmallestText && width_at(size) > style.most_width) --size;
  OIIO::ImageSpec spec(picture.width(), picture.height(), 4, OIIO::TypeDesc::FLOAT);
  spec.alpha_channel = 3;
  OIIO::ImageBuf buffer(spec, picture.pixels().data());
  const Colour ink = from_srgb(kInk);
  const std::array<float, 4> colour = {ink.red, ink.green, ink.blue, 1};
  if (!OIIO::ImageBufAlgo::render_text(buffer, x, y + size / 3, text, size, kFont, colour,
                                       align_of(style.anchor),
                                       OIIO::ImageBufAlgo::TextAlignY::Baseline, 0, {}, 1)) {
    throw Error(ErrorCode::Unreadable, {}, "", "no labels: " + buffer.geterror());
  }
}

void check_picture_name(const std::filesystem::path& path) {
  const std::string extension = lower_case_ending(path);
  if (extension == ".png" || extension == ".exr" || is_jpeg(extension)) return;
  throw Error(ErrorCode::Unsupported, path, "", "pictures end in .png, .jpg or .exr");
}

void write_picture(const Image& picture, const std::filesystem::path& path) {
  check_picture_name(path);
  const std::vector<unsigned char> bytes = encode(picture, path);
  OutputFile file(path);
  file.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  file.commit();
}

Image read_picture(const std::filesystem::path& path) {
  const auto input = OIIO::ImageInput::open(path.string());
  if (!input) throw Error(ErrorCode::Unreadable, path, "", OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  Image picture(spec.width, spec.height, {0, 0, 0, 1});
  std::vector<float> values(picture.pixels().size() * static_cast<std::size_t>(spec.nchannels));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data())) {
    throw Error(ErrorCode::Unreadable, path, "", input->geterror());
  }
  const bool is_exr = lower_case_ending(path) == ".exr";
  const auto light = [&](float value) { return is_exr ? value : decode_srgb(value); };
  for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
    const float* v = values.data() + i * static_cast<std::size_t>(spec.nchannels);
    picture.pixels()[i] = {light(v[0]), light(v[1]), light(v[2]), spec.nchannels > 3 ? v[3] : 1};
  }
  return picture;
}

}  // namespace triglyph
