#include "content/load/files/png_check.h"

#include "ecs/base/text.h"

#include <array>
#include <cstring>
#include <string_view>

namespace limn {

namespace {

constexpr std::array<std::uint32_t, 256> make_crc_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
        std::uint32_t crc = i;
        for (int k = 0; k < 8; ++k) {
            crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
        }
        table[i] = crc;
    }
    return table;
}

constexpr std::array<std::uint32_t, 256> kCrcTable = make_crc_table();

std::uint32_t big_endian(std::span<const std::byte> bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value = (value << 8) | std::to_integer<std::uint32_t>(bytes[i]);
    }
    return value;
}

}  // namespace

std::uint32_t crc32_of(std::span<const std::byte> bytes) {
    std::uint32_t crc = 0xffffffffu;
    for (const std::byte byte : bytes) {
        crc = (crc >> 8) ^ kCrcTable[(crc ^ std::to_integer<std::uint32_t>(byte)) & 0xffu];
    }
    return ~crc;
}

Status check_png(std::span<const std::byte> bytes, const std::string& location) {
    constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
    if (bytes.size() < kSignature.size()
        || std::memcmp(bytes.data(), kSignature.data(), kSignature.size()) != 0) {
        return fail("{}: found {} bytes without the PNG signature", location, bytes.size());
    }
    std::span<const std::byte> rest = bytes.subspan(kSignature.size());
    for (bool first = true;; first = false) {
        // length, type, data, checksum of type and data
        if (rest.size() < 12) {
            return fail("{}: truncated PNG image", location);
        }
        const std::uint32_t length = big_endian(rest);
        const std::string type(reinterpret_cast<const char*>(rest.data()) + 4, 4);
        if (first && (type != "IHDR" || length != 13)) {
            return fail("{}: corrupt PNG image: it does not begin with a header", location);
        }
        if (length > rest.size() - 12) {
            return fail("{}: truncated PNG image", location);
        }
        if (crc32_of(rest.subspan(4, 4 + std::size_t{length}))
            != big_endian(rest.subspan(8 + std::size_t{length}))) {
            return fail(
                "{}: corrupt PNG image: wrong checksum {} bytes before its end", location,
                rest.size());
        }
        if (type == "IEND") {
            return Done{};
        }
        rest = rest.subspan(12 + std::size_t{length});
    }
}

}  // namespace limn
