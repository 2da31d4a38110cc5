#include "output/packing.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <new>

namespace strata {

namespace {

constexpr std::size_t width = 4;          // bytes of a value
constexpr int fastest = 1;                // libdeflate's levels
constexpr std::size_t sample = 1024;      // bytes that tell whether more are worth the search
constexpr std::size_t longest = 0xffff;   // bytes of a stored block
constexpr std::size_t head = 2, sum = 4;  // bytes of a zlib stream around its blocks

// Bytes of all values side by side: the first ones, then the second ones and so on.
void shuffle(std::span<const std::byte> values, std::vector<unsigned char>& planes) {
  const std::size_t n = values.size() / width;
  planes.resize(values.size());
  unsigned char* const plane = planes.data();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t byte = 0; byte < width; ++byte)
      plane[byte * n + k] = static_cast<unsigned char>(values[width * k + byte]);
  }
}

// Appends stored blocks; `last`: the stream ends with them.
void store(std::span<const unsigned char> bytes, bool last, std::vector<unsigned char>& out) {
  while (!bytes.empty()) {
    const std::size_t n = std::min(bytes.size(), longest);
    const auto low = static_cast<unsigned char>(n & 0xffU), high = static_cast<unsigned char>(n >> 8U);
    const unsigned char final_block = last && n == bytes.size() ? 1 : 0;
    for (const int byte : {+final_block, +low, +high, low ^ 0xff, high ^ 0xff})
      out.push_back(static_cast<unsigned char>(byte));
    out.insert(out.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    bytes = bytes.subspan(n);
  }
}

}  // namespace

void Packer::Free::operator()(libdeflate_compressor* compressor) const {
  libdeflate_free_compressor(compressor);
}

Packer::Packer() : compressor_(libdeflate_alloc_compressor(fastest)), sample_(2 * sample) {
  if (!compressor_) throw std::bad_alloc();
}

// Whether the first bytes of a plane tell that it is worth the search.
bool Packer::shrinks(std::span<const unsigned char> plane) {
  const std::size_t n = std::min(sample, plane.size());
  if (std::memcmp(plane.data(), plane.data() + 1, n - 1) == 0) return true;  // all are equal
  const std::size_t size =
      libdeflate_deflate_compress(compressor_.get(), plane.data(), n, sample_.data(), sample_.size());
  return size > 0 && 5 * size < 4 * n;
}

std::vector<unsigned char> Packer::shuffled_and_deflated(std::span<const std::byte> values) {
  const std::size_t n = values.size() / width;
  shuffle(values, planes_);
  const std::span<const unsigned char> all(planes_);
  std::size_t noise = 0;  // bytes that are stored
  while (noise < all.size() && !shrinks(all.subspan(noise, n))) noise += n;
  const std::span<const unsigned char> rest = all.subspan(noise);

  std::vector<unsigned char> out{0x78, 0x01};  // deflate, a window of 32 KiB, the fastest level
  const std::size_t stored = noise + 5 * (noise / longest + 1);
  out.reserve(head + stored + libdeflate_deflate_compress_bound(compressor_.get(), rest.size()) + sum);
  store(all.first(noise), rest.empty(), out);
  if (!rest.empty()) {
    const std::size_t before = out.size();
    out.resize(out.capacity() - sum);
    const std::size_t size = libdeflate_deflate_compress(compressor_.get(), rest.data(), rest.size(),
                                                         out.data() + before, out.size() - before);
    out.resize(before + size);
  }
  const std::uint32_t check = libdeflate_adler32(1, all.data(), all.size());
  for (const unsigned shift : {24U, 16U, 8U, 0U}) out.push_back(static_cast<unsigned char>(check >> shift));
  return out;
}

}  // namespace strata
