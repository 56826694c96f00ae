#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace limn {

// Binary files: consecutive values, little-endian, without alignment.

static_assert(std::endian::native == std::endian::little);

class ByteWriter {
  public:
    void bytes(const void* data, std::size_t size) {
        const auto* first = static_cast<const std::byte*>(data);
        bytes_.insert(bytes_.end(), first, first + size);
    }
    template <typename T>
    void value(T value) {
        static_assert(std::is_arithmetic_v<T>);
        bytes(&value, sizeof value);
    }
    void text(std::string_view text) {
        value(static_cast<std::uint32_t>(text.size()));
        bytes(text.data(), text.size());
    }
    /// Overwrites the value at `offset`.
    template <typename T>
    void patch(std::size_t offset, T value) {
        static_assert(std::is_arithmetic_v<T>);
        std::memcpy(bytes_.data() + offset, &value, sizeof value);
    }
    void overwrite(std::size_t offset, const void* data, std::size_t size) {
        if (size > 0) {
            std::memcpy(bytes_.data() + offset, data, size);
        }
    }
    void clear() { bytes_.clear(); }
    void reserve(std::size_t size) { bytes_.reserve(size); }
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }
    [[nodiscard]] const std::byte* data() const { return bytes_.data(); }
    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

  private:
    std::vector<std::byte> bytes_;
};

/// Reads untrusted bytes: past the end it returns zeros and failed() becomes true.
class ByteReader {
  public:
    explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    [[nodiscard]] bool failed() const { return failed_; }
    [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }
    [[nodiscard]] std::size_t position() const { return position_; }

    /// The next `size` bytes; empty if fewer are left.
    std::span<const std::byte> bytes(std::size_t size) {
        if (failed_ || size > left()) {
            failed_ = true;
            return {};
        }
        const std::span<const std::byte> taken = bytes_.subspan(position_, size);
        position_ += size;
        return taken;
    }
    /// Returns false, and copies nothing, if fewer bytes are left.
    bool copy(void* destination, std::size_t size) {
        const std::span<const std::byte> taken = bytes(size);
        if (failed_) {
            return false;
        }
        if (size > 0) {
            std::memcpy(destination, taken.data(), size);
        }
        return true;
    }
    template <typename T>
    T value() {
        static_assert(std::is_arithmetic_v<T>);
        T value{};
        copy(&value, sizeof value);
        return value;
    }
    std::string_view text() {
        const std::span<const std::byte> taken = bytes(value<std::uint32_t>());
        return {reinterpret_cast<const char*>(taken.data()), taken.size()};
    }
    /// Reads a count of elements of at least `min_size` bytes each; fails if the remaining bytes
    /// cannot hold them, before the caller allocates.
    std::uint32_t count(std::size_t min_size) {
        const auto count = value<std::uint32_t>();
        if (failed_ || (min_size > 0 && count > left() / min_size)) {
            failed_ = true;
            return 0;
        }
        return count;
    }

  private:
    std::span<const std::byte> bytes_;
    std::size_t position_ = 0;
    bool failed_ = false;
};

}  // namespace limn
