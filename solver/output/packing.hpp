// Large fields packed as HDF5's filters "shuffle" and "deflate" would, for its readers to unpack, in a third of the
// time.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace strata {

/// The bytes of four-byte values (4 n of them) as the filters shuffle and deflate store them: the first byte of every
/// value, then the second and so on, as one zlib stream (RFC 1950). The low bytes of fields are noise that no search
/// shortens; bytes whose sample does not shrink by a tenth are stored as they are (RFC 1951, 3.2.4). Empty where zlib
/// has no memory.
std::vector<unsigned char> shuffled_and_deflated(std::span<const std::byte> values);

}  // namespace strata
