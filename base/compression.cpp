#include "base/compression.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <utility>

namespace prismesh {
namespace {

/// Bytes that are unpacked between two calls of the progress.
constexpr std::size_t kStep = std::size_t{256} << 10;
/// zlib counts with 32 bits.
constexpr std::size_t kMaxIn = std::size_t{1} << 30;
constexpr int kGzip = 16 + MAX_WBITS;

const unsigned char* raw(std::span<const std::byte> bytes) { return reinterpret_cast<const unsigned char*>(bytes.data()); }

/// Text that grows until it reaches a limit, or more than what the packed bytes read so far may hold.
class GrowingText {
 public:
  /// `max`: characters. There is space for one more, so that a text which is just as long is seen to end.
  GrowingText(std::size_t first, std::size_t max) : max_(max) { reserve(std::min(std::max<std::size_t>(first, 1024), max + 1)); }

  /// Space for at least one more byte; empty: out of memory. Precondition: refusal() gave no reason.
  std::span<char> room() {
    if (size_ == capacity_) reserve(capacity_ + std::min(capacity_ / 2 + 1, max_ + 1 - capacity_));
    return {data_.get() + size_, size_ < capacity_ ? std::min(capacity_ - size_, kStep) : 0};
  }
  void took(std::size_t count) { size_ += count; }
  /// Why no more is unpacked after so many packed bytes; empty: there is no reason.
  std::string refusal(std::size_t packed_bytes) const {
    if (size_ > max_unpacked(packed_bytes)) return "unpacks to more than 200 times its size, as no deck does; it isn't read";
    if (size_ > max_)
      return "unpacks to more than the " + std::to_string(max_ >> 20) + " MB that are left for packed files of a deck; unpack it first";
    return {};
  }
  std::size_t size() const { return size_; }
  /// The text with a NUL behind it; null: out of memory.
  std::unique_ptr<char[]> finish() {
    data_[size_] = '\0';
    // Returns memory if the guess was far too large.
    if (capacity_ - size_ < size_ / 8 + 4096) return std::move(data_);
    std::unique_ptr<char[]> fitting(new (std::nothrow) char[size_ + 1]);
    if (!fitting) return std::move(data_);
    std::memcpy(fitting.get(), data_.get(), size_ + 1);
    return fitting;
  }

 private:
  void reserve(std::size_t capacity) {
    if (data_ && capacity <= capacity_) return;
    std::unique_ptr<char[]> more(new (std::nothrow) char[capacity + 1]);
    if (!more) return;
    if (size_ > 0) std::memcpy(more.get(), data_.get(), size_);
    data_ = std::move(more);
    capacity_ = capacity;
  }

  std::size_t max_;
  std::unique_ptr<char[]> data_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// A zlib stream that ends when it goes out of scope.
struct Inflating {
  z_stream stream{};
  bool good = inflateInit2(&stream, kGzip) == Z_OK;
  Inflating() = default;
  Inflating(const Inflating&) = delete;
  Inflating& operator=(const Inflating&) = delete;
  ~Inflating() {
    if (good) inflateEnd(&stream);
  }
};

bool is_zero(std::span<const std::byte> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

/// Errors name no file.
Result<void> unpack_gzip(std::span<const std::byte> in, GrowingText& out, const Progress& progress) {
  Inflating inflating;
  if (!inflating.good) return fail("", "can't be unpacked: out of memory");
  z_stream& z = inflating.stream;
  std::size_t at = 0;
  for (;;) {
    const std::span<char> room = out.room();
    if (room.empty()) return fail("", "is too large for this machine's memory once unpacked");
    const std::size_t given = std::min(in.size() - at, kMaxIn);
    z.next_in = const_cast<unsigned char*>(raw(in.subspan(at)));
    z.avail_in = static_cast<uInt>(given);
    z.next_out = reinterpret_cast<unsigned char*>(room.data());
    z.avail_out = static_cast<uInt>(room.size());
    const int result = inflate(&z, Z_NO_FLUSH);
    at += given - z.avail_in;
    out.took(room.size() - z.avail_out);
    if (std::string why = out.refusal(at); !why.empty()) return fail(Error{"", 0, std::move(why), ErrorKind::over_limit});
    if (result == Z_STREAM_END) {
      const std::span<const std::byte> rest = in.subspan(at);
      if (is_zero(rest)) return {};
      if (packing_of(rest) != Packing::gzip) return fail("", "has something else behind its gzip data");
      if (inflateReset(&z) != Z_OK) return fail("", "can't be unpacked: out of memory");
    } else if (result == Z_BUF_ERROR || (result == Z_OK && at == in.size() && z.avail_out > 0)) {
      return fail("", "is cut off: its gzip data end too early");
    } else if (result != Z_OK) {
      return fail("",
                  std::string("is damaged: its gzip data can't be unpacked") + (z.msg ? std::string(" (") + z.msg + ")" : std::string()));
    }
    if (progress && !progress(static_cast<double>(at) / static_cast<double>(in.size()))) return fail(cancelled());
  }
}

struct FreeDecompressor {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};
struct FreeCompressor {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

/// Errors name no file.
Result<void> unpack_zstd(std::span<const std::byte> in, GrowingText& out, const Progress& progress) {
  const std::unique_ptr<ZSTD_DCtx, FreeDecompressor> context(ZSTD_createDCtx());
  if (!context) return fail("", "can't be unpacked: out of memory");
  ZSTD_inBuffer from{in.data(), in.size(), 0};
  for (std::size_t left = 1; from.pos < from.size || left != 0;) {
    const std::span<char> room = out.room();
    if (room.empty()) return fail("", "is too large for this machine's memory once unpacked");
    ZSTD_outBuffer to{room.data(), room.size(), 0};
    const std::size_t before = from.pos;
    // Zero at the end of each frame; the next one begins by itself.
    left = ZSTD_decompressStream(context.get(), &to, &from);
    out.took(to.pos);
    if (std::string why = out.refusal(from.pos); !why.empty()) return fail(Error{"", 0, std::move(why), ErrorKind::over_limit});
    if (ZSTD_isError(left)) return fail("", std::string("is damaged, or is no zstd file all through (") + ZSTD_getErrorName(left) + ")");
    if (left != 0 && from.pos == from.size && from.pos == before && to.pos == 0) return fail("", "is cut off: its zstd data end too early");
    if (progress && !progress(static_cast<double>(from.pos) / static_cast<double>(from.size))) return fail(cancelled());
  }
  return {};
}

/// Guesses the size of the text: the size that the file states, where that is plausible.
std::size_t likely_size(std::span<const std::byte> in, Packing packing) {
  const std::size_t usual = 5 * in.size();
  if (packing == Packing::zstd) {
    const unsigned long long size = ZSTD_getFrameContentSize(in.data(), in.size());
    if (size != ZSTD_CONTENTSIZE_UNKNOWN && size != ZSTD_CONTENTSIZE_ERROR && size < 40 * in.size()) return static_cast<std::size_t>(size);
    return usual;
  }
  if (in.size() < 18) return usual;
  std::size_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) size |= static_cast<std::size_t>(in[in.size() - 4 + i]) << (8 * i);
  // One byte more, so that the end is seen without growing.
  return size >= in.size() && size < 40 * in.size() ? size + 1 : usual;
}

}  // namespace

Packing packing_of(std::span<const std::byte> bytes) {
  const unsigned char* b = raw(bytes);
  if (bytes.size() == 2 || bytes.size() == 3)
    return b[0] == 0x1f && b[1] == 0x8b && (bytes.size() == 2 || b[2] == 8) ? Packing::gzip : Packing::none;
  if (bytes.size() < 4) return Packing::none;
  // 8: deflate, the only method there is.
  if (b[0] == 0x1f && b[1] == 0x8b && b[2] == 8) return Packing::gzip;
  if (b[0] == 0x28 && b[1] == 0xb5 && b[2] == 0x2f && b[3] == 0xfd) return Packing::zstd;
  // A skippable frame; some tools begin with one.
  if ((b[0] & 0xf0) == 0x50 && b[1] == 0x2a && b[2] == 0x4d && b[3] == 0x18) return Packing::zstd;
  return Packing::none;
}

Result<FileBytes> unpack(FileBytes file, const std::filesystem::path& path, const Progress& progress, std::size_t max_bytes) {
  const std::span<const std::byte> in = file.bytes();
  const Packing packing = packing_of(in);
  if (packing == Packing::none) return file;
  GrowingText out(likely_size(in, packing), max_bytes);
  const Result<void> unpacked = packing == Packing::gzip ? unpack_gzip(in, out, progress) : unpack_zstd(in, out, progress);
  if (!unpacked && is_cancelled(unpacked.error())) return fail(unpacked.error());
  if (!unpacked) return fail(Error{path.string(), 0, unpacked.error().message, unpacked.error().kind});
  const std::size_t size = out.size();
  return FileBytes::unpacked(std::move(file), out.finish(), size);
}

namespace {

/// The header of a gzip file's first member: name, time and so on. The buffers must outlive the header.
struct GzipHeader {
  gz_header header{};
  std::array<unsigned char, 4096> name{};
  std::array<unsigned char, 4096> comment{};
  int level = 6;

  explicit GzipHeader(std::span<const std::byte> like) {
    Inflating inflating;
    if (!inflating.good) return;
    header.name = name.data();
    header.name_max = static_cast<uInt>(name.size() - 1);
    header.comment = comment.data();
    header.comm_max = static_cast<uInt>(comment.size() - 1);
    unsigned char nothing = 0;
    inflating.stream.next_in = const_cast<unsigned char*>(raw(like));
    inflating.stream.avail_in = static_cast<uInt>(std::min(like.size(), kMaxIn));
    inflating.stream.next_out = &nothing;
    inflating.stream.avail_out = 1;
    inflateGetHeader(&inflating.stream, &header);
    inflate(&inflating.stream, Z_BLOCK);
    level = header.xflags == 2 ? 9 : header.xflags == 4 ? 1 : 6;
    // zlib has set the pointers of missing fields to null, and leaves these fields out.
    header.extra = nullptr;
    header.extra_len = 0;
    header.hcrc = 0;
  }
};

/// Passes a text to a packer, at most a megabyte at a time, and reports the progress.
class TextFeed {
 public:
  TextFeed(std::span<const std::string_view> text, const Progress& progress) : text_(text), progress_(progress) {
    for (const std::string_view piece : text) all_ += piece.size();
  }
  std::size_t all() const { return all_; }

  /// Calls `take(part)` with each part; it returns false if it can't continue. Errors: that, cancelled.
  template <typename Take>
  Result<void> to(const Take& take) {
    std::size_t given = 0;
    std::size_t told = 0;
    for (std::string_view piece : text_)
      while (!piece.empty()) {
        const std::string_view part = piece.substr(0, kTextStep);
        if (!take(part)) return fail("", "can't be packed: out of memory");
        given += part.size();
        piece.remove_prefix(part.size());
        if (!progress_ || given - told < kTextStep) continue;
        told = given;
        if (!progress_(static_cast<double>(given) / static_cast<double>(all_))) return fail(cancelled());
      }
    return {};
  }

 private:
  static constexpr std::size_t kTextStep = std::size_t{1} << 20;
  std::span<const std::string_view> text_;
  const Progress& progress_;
  std::size_t all_ = 0;
};

Result<std::string> pack_gzip(TextFeed text, std::span<const std::byte> like) {
  GzipHeader header(like);
  z_stream z{};
  if (deflateInit2(&z, header.level, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK) return fail("", "can't be packed: out of memory");
  deflateSetHeader(&z, &header.header);
  std::string out;
  const std::unique_ptr<unsigned char[]> buffer(new unsigned char[kStep]);
  const auto run = [&](int flush) {
    do {
      z.next_out = buffer.get();
      z.avail_out = static_cast<uInt>(kStep);
      deflate(&z, flush);
      out.append(reinterpret_cast<const char*>(buffer.get()), kStep - z.avail_out);
    } while (z.avail_out == 0);
  };
  const Result<void> given = text.to([&](std::string_view part) {
    z.next_in = reinterpret_cast<unsigned char*>(const_cast<char*>(part.data()));
    z.avail_in = static_cast<uInt>(part.size());
    run(Z_NO_FLUSH);
    return true;
  });
  if (given) run(Z_FINISH);
  deflateEnd(&z);
  if (!given) return fail(given.error());
  return out;
}

Result<std::string> pack_zstd(TextFeed text, std::span<const std::byte> like) {
  const std::unique_ptr<ZSTD_CCtx, FreeCompressor> context(ZSTD_createCCtx());
  if (!context) return fail("", "can't be packed: out of memory");
  // Bit 2 of the byte behind the magic number; a skippable frame has none, and a checksum does no harm.
  const bool plain_frame = raw(like)[0] == 0x28;
  const bool checksum = !plain_frame || like.size() < 5 || (raw(like)[4] & 4) != 0;
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, checksum);
  ZSTD_CCtx_setPledgedSrcSize(context.get(), text.all());
  std::string out;
  const std::unique_ptr<char[]> buffer(new char[kStep]);
  const auto run = [&](std::string_view piece, ZSTD_EndDirective what) -> bool {
    ZSTD_inBuffer from{piece.data(), piece.size(), 0};
    for (std::size_t left = 1; left != 0;) {
      ZSTD_outBuffer to{buffer.get(), kStep, 0};
      left = ZSTD_compressStream2(context.get(), &to, &from, what);
      if (ZSTD_isError(left)) return false;
      out.append(buffer.get(), to.pos);
      if (what == ZSTD_e_continue && from.pos == from.size) return true;
    }
    return true;
  };
  if (const Result<void> given = text.to([&](std::string_view part) { return run(part, ZSTD_e_continue); }); !given)
    return fail(given.error());
  if (!run({}, ZSTD_e_end)) return fail("", "can't be packed: out of memory");
  return out;
}

}  // namespace

Result<std::string> pack(std::span<const std::string_view> text, std::span<const std::byte> like, const Progress& progress) {
  const TextFeed feed(text, progress);
  return packing_of(like) == Packing::zstd ? pack_zstd(feed, like) : pack_gzip(feed, like);
}

}  // namespace prismesh
