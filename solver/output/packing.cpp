#include "output/packing.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>

namespace strata {

namespace {

constexpr std::size_t width = 4;  // bytes of a value
constexpr int fastest = 1;        // zlib's levels

// Whether the first bytes of a plane tell that it is worth the search.
bool shrinks(std::span<unsigned char> plane) {
  constexpr std::size_t sample = 4096;
  std::array<unsigned char, 2 * sample> out{};
  uLongf size = out.size();
  const std::size_t n = std::min(sample, plane.size());
  return compress2(out.data(), &size, plane.data(), n, fastest) == Z_OK && 10 * size < 9 * n;
}

}  // namespace

std::vector<unsigned char> shuffled_and_deflated(std::span<const std::byte> values) {
  const std::size_t n = values.size() / width;
  std::vector<unsigned char> planes(values.size());
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t byte = 0; byte < width; ++byte)
      planes[byte * n + k] = static_cast<unsigned char>(values[width * k + byte]);
  }
  z_stream stream{};
  if (deflateInit(&stream, fastest) != Z_OK) return {};
  std::vector<unsigned char> out(deflateBound(&stream, values.size()) + 64 * width);  // a new level ends a block
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  bool sound = true;
  for (std::size_t byte = 0; byte < width; ++byte) {
    const std::span plane(planes.data() + byte * n, n);
    sound = sound && deflateParams(&stream, shrinks(plane) ? fastest : Z_NO_COMPRESSION, Z_DEFAULT_STRATEGY) == Z_OK;
    stream.next_in = plane.data();
    stream.avail_in = static_cast<uInt>(n);
    const int end = deflate(&stream, byte + 1 < width ? Z_NO_FLUSH : Z_FINISH);
    sound = sound && end == (byte + 1 < width ? Z_OK : Z_STREAM_END);
  }
  out.resize(sound ? stream.total_out : 0);
  deflateEnd(&stream);
  return out;
}

}  // namespace strata
