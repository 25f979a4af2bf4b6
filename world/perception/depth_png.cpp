#include <locograph/common/atomic_file.h>
#include <locograph/common/control_characters.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/common/parse_number.h>
#include <locograph/world/perception/depth_png.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace locograph {
namespace {

/// Far more than a raw image of the largest size.
constexpr std::uintmax_t kMostPngBytes = std::uintmax_t{256} << 20;
constexpr const char* kStampKey = "stamp_s";
constexpr const char* kCameraKey = "camera";

/// The numbers of a camera that a file has.
struct CameraKey {
  const char* key;
  double DepthCamera::*value;
};
constexpr std::array<CameraKey, 6> kCameraNumbers = {{{"fx", &DepthCamera::fx},
                                                      {"fy", &DepthCamera::fy},
                                                      {"cx", &DepthCamera::cx},
                                                      {"cy", &DepthCamera::cy},
                                                      {"range_min_m", &DepthCamera::range_min_m},
                                                      {"range_max_m", &DepthCamera::range_max_m}}};

/// Whether all chunks are there up to the last: libpng takes memory for what their heads promise.
bool is_whole(std::string_view png) {
  constexpr std::size_t kSignature = 8, kFrame = 12;  // of a chunk: size, kind, checksum
  for (std::size_t at = kSignature; at + kFrame <= png.size();) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<unsigned char>(png[at + i]);
    if (size > png.size() - at - kFrame) return false;
    if (png.substr(at + 4, 4) == "IEND") return true;
    at += kFrame + size;
  }
  return false;
}

/// libpng leaves by longjmp, past the destructors of C++. So whatever calls it is a function
/// without objects of its own, between run() and libpng, and what it needs is a member here.
class PngSession {
 public:
  PngSession(const PngSession&) = delete;
  PngSession& operator=(const PngSession&) = delete;

 protected:
  PngSession() = default;
  ~PngSession() = default;

  /// What keep_message() is handed back.
  PngSession* session() { return this; }

  static void keep_message(png_structp png, png_const_charp text) {
    auto* session = static_cast<PngSession*>(png_get_error_ptr(png));
    std::snprintf(session->message_, sizeof session->message_, "%s", text);
    png_longjmp(png, 1);
  }
  static void ignore(png_structp, png_const_charp) {}

  /// Calls step(*this), a function without objects. False: libpng gave up, for message().
  template <class Session>
  static bool run(Session& session, void (*step)(Session&)) {
    if (setjmp(png_jmpbuf(session.png_)) != 0) return false;
    step(session);
    return true;
  }

  std::string message() const { return without_controls(message_, "\\x"); }

  png_structp png_ = nullptr;
  png_infop info_ = nullptr;

 private:
  char message_[160] = {};
};

class PngReader : public PngSession {
 public:
  PngReader(const std::string& file, std::string_view content) : file_(file), content_(content) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, session(), keep_message, ignore);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw Error("libpng cannot be used", "one of version " PNG_LIBPNG_VER_STRING);
    }
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  DepthImage read() {
    require(run<PngReader>(*this, begin));
    DepthImage image;
    require_depth_image(image);
    row_.resize(static_cast<std::size_t>(image.width));
    for (int row = 0; row < image.height; ++row) {
      require(run<PngReader>(*this, read_row));
      image.depth_mm.insert(image.depth_mm.end(), row_.begin(), row_.end());
    }
    require(run<PngReader>(*this, finish));
    return image;
  }

  /// After read(). Throws Error where a key is there twice.
  std::map<std::string, std::string> texts() const {
    png_textp texts = nullptr;
    int count = 0;
    png_get_text(png_, info_, &texts, &count);
    std::map<std::string, std::string> all;
    for (int i = 0; i < count; ++i) {
      const std::string key = texts[i].key;
      if (!is_ours(key)) continue;
      if (!all.emplace(key, texts[i].text == nullptr ? "" : texts[i].text).second) {
        throw Error(file_, 0, "a second text '" + key + "'", "one");
      }
    }
    return all;
  }

 private:
  static bool is_ours(const std::string& key) {
    return key == kStampKey || key == kCameraKey ||
           std::any_of(kCameraNumbers.begin(), kCameraNumbers.end(),
                       [&](const CameraKey& one) { return key == one.key; });
  }

  void require(bool good) const {
    if (!good) throw Error(file_, 0, "no readable PNG (" + message() + ")", "a depth image");
  }

  void require_depth_image(DepthImage& image) const {
    const png_uint_32 width = png_get_image_width(png_, info_);
    const png_uint_32 height = png_get_image_height(png_, info_);
    constexpr png_uint_32 kMost = DepthCamera::kMostPixels;
    if (width > kMost || height > kMost) {
      throw Error(
          file_, 0,
          "an image of " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
          "at most " + std::to_string(kMost) + " each way");
    }
    const int bits = png_get_bit_depth(png_, info_), kind = png_get_color_type(png_, info_);
    if (bits != 16 || kind != PNG_COLOR_TYPE_GRAY) {
      throw Error(file_, 0,
                  "an image of " + std::to_string(bits) + " bits in " +
                      (kind == PNG_COLOR_TYPE_GRAY ? "grey" : "colour or with transparency"),
                  "16 bits in grey");
    }
    if (png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE) {
      throw Error(file_, 0, "an interlaced image", "one that is not");
    }
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
  }

  static void take_bytes(png_structp png, png_bytep out, std::size_t size) {
    auto* reader = static_cast<PngReader*>(png_get_io_ptr(png));
    if (size > reader->content_.size()) png_error(png, "truncated");
    std::memcpy(out, reader->content_.data(), size);
    reader->content_.remove_prefix(size);
  }

  static void begin(PngReader& reader) {
    constexpr png_uint_32 kAnySize = 0x7fffffff;
    constexpr png_alloc_size_t kMostOfChunk = 1 << 20;
    png_set_read_fn(reader.png_, &reader, take_bytes);
    png_set_user_limits(reader.png_, kAnySize, kAnySize);  // ours come with a better message
    png_set_chunk_malloc_max(reader.png_, kMostOfChunk);
    png_set_crc_action(reader.png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_read_info(reader.png_, reader.info_);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(reader.png_);
  }
  static void read_row(PngReader& reader) {
    png_read_row(reader.png_, reinterpret_cast<png_bytep>(reader.row_.data()), nullptr);
  }
  static void finish(PngReader& reader) { png_read_end(reader.png_, reader.info_); }

  const std::string& file_;
  std::string_view content_;  ///< what is left
  std::vector<std::uint16_t> row_;
};

class PngWriter : public PngSession {
 public:
  PngWriter(const DepthImage& image, const std::vector<std::pair<std::string, std::string>>& texts)
      : image_(image) {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, session(), keep_message, ignore);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, nullptr);
      throw Error("libpng cannot be used", "one of version " PNG_LIBPNG_VER_STRING);
    }
    for (const auto& [key, text] : texts) {
      png_text& chunk = texts_.emplace_back();
      chunk = {};
      chunk.compression = PNG_TEXT_COMPRESSION_NONE;
      chunk.key = const_cast<char*>(key.c_str());  // libpng copies it
      chunk.text = const_cast<char*>(text.c_str());
      chunk.text_length = text.size();
    }
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }

  std::string write() {
    if (!run<PngWriter>(*this, write_all)) throw Error("no PNG can be made: " + message());
    return std::move(out_);
  }

 private:
  static void add_bytes(png_structp png, png_bytep bytes, std::size_t size) {
    auto* writer = static_cast<PngWriter*>(png_get_io_ptr(png));
    bool added = true;
    try {
      writer->out_.append(reinterpret_cast<const char*>(bytes), size);
    } catch (...) {
      added = false;  // no exception may pass through libpng
    }
    if (!added) png_error(png, "no memory");
  }
  static void flush(png_structp) {}

  static void write_all(PngWriter& writer) {
    const DepthImage& image = writer.image_;
    png_set_write_fn(writer.png_, &writer, add_bytes, flush);
    png_set_IHDR(writer.png_, writer.info_, static_cast<png_uint_32>(image.width),
                 static_cast<png_uint_32>(image.height), 16, PNG_COLOR_TYPE_GRAY,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_text(writer.png_, writer.info_, writer.texts_.data(),
                 static_cast<int>(writer.texts_.size()));
    png_write_info(writer.png_, writer.info_);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(writer.png_);
    for (int row = 0; row < image.height; ++row) {
      const std::uint16_t* first =
          image.depth_mm.data() +
          static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width);
      png_write_row(writer.png_, reinterpret_cast<png_const_bytep>(first));
    }
    png_write_end(writer.png_, writer.info_);
  }

  const DepthImage& image_;
  std::vector<png_text> texts_;
  std::string out_;
};

double number_text(const std::string& file, const std::map<std::string, std::string>& texts,
                   const char* key) {
  const auto found = texts.find(key);
  double value = 0.0;
  if (found == texts.end()) {
    throw Error(file, 0, "no text '" + std::string(key) + "'", "all numbers of its camera");
  }
  if (!parse_number(found->second, value) || !std::isfinite(value)) {
    const std::string shown = without_controls(found->second.substr(0, 40), "\\x");
    throw Error(file, 0, "the text '" + std::string(key) + "' is '" + shown + "'",
                "one finite number");
  }
  return value;
}

DepthCamera camera_in(const std::string& file, const std::map<std::string, std::string>& texts,
                      const DepthImage& image) {
  DepthCamera camera;
  const auto name = texts.find(kCameraKey);
  if (name == texts.end()) throw Error(file, 0, "no text 'camera'", "the camera's name");
  camera.name = without_controls(name->second.substr(0, 200), "\\x");
  camera.width = image.width;
  camera.height = image.height;
  for (const CameraKey& one : kCameraNumbers) camera.*one.value = number_text(file, texts, one.key);
  try {
    camera.validate();
  } catch (const Error& error) {
    throw Error(file, 0, error.what(), "");
  }
  return camera;
}

std::string in_17_digits(double value) {
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, 17).ptr;
  return {text, end};
}

}  // namespace

DepthPng load_depth_png(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string content = read_file(path, kMostPngBytes, "a depth image (PNG)");
  if (!is_whole(content)) throw Error(file, 0, "no PNG, or truncated", "a depth image (PNG)");
  PngReader reader(file, content);
  DepthPng png;
  png.image = reader.read();
  std::map<std::string, std::string> texts = reader.texts();
  png.stamped = texts.contains(kStampKey);
  if (png.stamped) png.image.stamp_s = number_text(file, texts, kStampKey);
  texts.erase(kStampKey);
  if (!texts.empty()) png.camera = camera_in(file, texts, png.image);
  return png;
}

void save_depth_png(const std::filesystem::path& path, const DepthImage& image,
                    const DepthCamera& camera) {
  camera.validate();
  const auto pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (image.width != camera.width || image.height != camera.height ||
      image.depth_mm.size() != pixels) {
    throw Error("the image is not of its camera's size",
                std::to_string(camera.width) + " x " + std::to_string(camera.height) + " pixels");
  }
  if (!std::isfinite(image.stamp_s)) throw Error("the image's stamp is not finite", "seconds");
  std::vector<std::pair<std::string, std::string>> texts = {
      {kStampKey, in_17_digits(image.stamp_s)}, {kCameraKey, camera.name}};
  for (const CameraKey& one : kCameraNumbers) {
    texts.emplace_back(one.key, in_17_digits(camera.*one.value));
  }
  write_file_atomically(path, PngWriter(image, texts).write());
}

}  // namespace locograph
