// Large fields packed as HDF5's filters "shuffle" and "deflate" would, for its readers to unpack, in a fraction of the
// time.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

struct libdeflate_compressor;

namespace strata {

// Packs one field after another; holds the memory that this takes.
class Packer {
 public:
  /// Throws std::bad_alloc where there is no memory.
  Packer();

  /// The bytes of four-byte values (4 n of them, n > 0) as the filters shuffle and deflate store them: the first byte
  /// of every value, then the second and so on, as one zlib stream (RFC 1950). The low bytes of fields are noise that
  /// no search shortens: those before the first whose sample shrinks by a fifth are stored as they are (RFC 1951,
  /// 3.2.4).
  std::vector<unsigned char> shuffled_and_deflated(std::span<const std::byte> values);

 private:
  struct Free {
    void operator()(libdeflate_compressor* compressor) const;
  };
  bool shrinks(std::span<const unsigned char> plane);
  std::unique_ptr<libdeflate_compressor, Free> compressor_;
  std::vector<unsigned char> planes_, sample_;
};

}  // namespace strata
