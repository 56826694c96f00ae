#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

namespace limn {

// XXH64 (Y. Collet, xxHash 0.8, specification of the 64-bit variant): some 10 GB/s, identical on
// every little-endian machine. Detects differences and corruption; not cryptographic.

/// XXH64 of `size` bytes.
[[nodiscard]] std::uint64_t hash_bytes(const void* bytes, std::size_t size, std::uint64_t seed = 0);

[[nodiscard]] inline std::uint64_t
hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed = 0) {
    return hash_bytes(bytes.data(), bytes.size(), seed);
}
[[nodiscard]] inline std::uint64_t hash_text(std::string_view text, std::uint64_t seed = 0) {
    return hash_bytes(text.data(), text.size(), seed);
}

/// Appends `value` to `hash`: the order of calls matters. One round and the avalanche of XXH64.
[[nodiscard]] constexpr std::uint64_t hash_combine(std::uint64_t hash, std::uint64_t value) {
    value *= 0xc2b2ae3d27d4eb4full;
    hash ^= std::rotl(value, 31) * 0x9e3779b185ebca87ull;
    hash = std::rotl(hash, 27) * 0x9e3779b185ebca87ull + 0x85ebca77c2b2ae63ull;
    hash = (hash ^ (hash >> 33)) * 0xc2b2ae3d27d4eb4full;
    hash = (hash ^ (hash >> 29)) * 0x165667b19e3779f9ull;
    return hash ^ (hash >> 32);
}

/// FNV-1a of a name, usable at compile time: for ids that must be the same in every program.
[[nodiscard]] constexpr std::uint32_t name_hash(std::string_view name) {
    std::uint32_t hash = 0x811c9dc5u;
    for (const char c : name) {
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193u;
    }
    return hash;
}

}  // namespace limn
