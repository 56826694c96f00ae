#include "ecs/base/hash.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <vector>

using namespace limn;

namespace {

/// The buffer of xxHash's own sanity test.
std::vector<unsigned char> sanity_buffer() {
    std::vector<unsigned char> bytes(2367);
    std::uint64_t generator = 2654435761u;
    for (unsigned char& byte : bytes) {
        byte = static_cast<unsigned char>(generator >> 56);
        generator *= 11400714785074694797ull;
    }
    return bytes;
}

}  // namespace

TEST_CASE("hash: XXH64 gives the published values for short and long input") {
    CHECK(hash_text("") == 0xef46db3751d8e999ull);
    CHECK(hash_text("a") == 0xd24ec4f1a98c6e5bull);
    CHECK(hash_text("abc") == 0x44bc2cf5ad770999ull);
    CHECK(hash_text("Nobody inspects the spammish repetition") == 0xfbcea83c8a378bf1ull);
    CHECK(
        hash_text("Call me Ishmael. Some years ago--never mind how long precisely-")
        == 0x02a2e85470d6fd96ull);
}

TEST_CASE("hash: XXH64 gives the published values with a seed, for every tail length") {
    constexpr std::uint64_t kSeed = 2654435761u;
    const std::vector<unsigned char> bytes = sanity_buffer();
    CHECK(hash_bytes(bytes.data(), 0, kSeed) == 0xac75fda2929b17efull);
    CHECK(hash_bytes(bytes.data(), 1) == 0xe934a84adb052768ull);
    CHECK(hash_bytes(bytes.data(), 1, kSeed) == 0x5014607643a9b4c3ull);
    CHECK(hash_bytes(bytes.data(), 4) == 0x9136a0dca57457eeull);
    CHECK(hash_bytes(bytes.data(), 14) == 0x8282dcc4994e35c8ull);
    CHECK(hash_bytes(bytes.data(), 14, kSeed) == 0xc3bd6bf63deb6df0ull);
    CHECK(hash_bytes(bytes.data(), 222) == 0xb641ae8cb691c174ull);
    CHECK(hash_bytes(bytes.data(), 222, kSeed) == 0x20cb8ab7ae10c14aull);
}

TEST_CASE("hash: the alignment of the bytes does not matter") {
    const std::vector<unsigned char> bytes = sanity_buffer();
    std::vector<unsigned char> moved(bytes.size() + 16);
    for (std::size_t shift = 0; shift < 16; ++shift) {
        std::copy(bytes.begin(), bytes.end(), moved.begin() + static_cast<std::ptrdiff_t>(shift));
        CHECK(hash_bytes(moved.data() + shift, 200) == hash_bytes(bytes.data(), 200));
    }
}

TEST_CASE("hash: flipping any bit flips about half of the hash") {
    std::vector<unsigned char> bytes(70, 0x5a);
    const std::uint64_t before = hash_bytes(bytes.data(), bytes.size());
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        bytes[bit / 8] ^= static_cast<unsigned char>(1u << (bit % 8));
        const int flipped = std::popcount(before ^ hash_bytes(bytes.data(), bytes.size()));
        CHECK(flipped >= 10);
        CHECK(flipped <= 54);
        bytes[bit / 8] ^= static_cast<unsigned char>(1u << (bit % 8));
    }
}

TEST_CASE("hash: combining depends on the order") {
    CHECK(hash_combine(hash_combine(1, 2), 3) != hash_combine(hash_combine(1, 3), 2));
    CHECK(hash_combine(0, 0) != 0);
    static_assert(name_hash("a") == 0xe40c292cu);
    static_assert(name_hash("foobar") == 0xbf9cf968u);
}
