#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn {

// Memory that never moves. A VirtualRange takes a large piece of the address space, which costs
// nothing, and turns the front of it into memory as it fills; so a column of an archetype grows
// without copies and its base pointer holds as long as the archetype. Small archetypes would waste
// a page a column: they share the blocks of a BlockPool, one block an archetype, until they outgrow
// the largest.

/// A reserved range of addresses whose front is readable and writable memory, zero at first.
class VirtualRange {
  public:
    VirtualRange() = default;
    /// Reserves at least `bytes`, page aligned. Stops the program if there is no address space
    /// left.
    explicit VirtualRange(std::size_t bytes);
    VirtualRange(VirtualRange&& other) noexcept;
    VirtualRange& operator=(VirtualRange&& other) noexcept;
    VirtualRange(const VirtualRange&) = delete;
    VirtualRange& operator=(const VirtualRange&) = delete;
    ~VirtualRange();

    /// Makes the first `bytes` usable, and some more: steps grow from 64 KiB to 2 MiB. Stops the
    /// program when the reservation or the memory is exhausted.
    void commit(std::size_t bytes) {
        if (bytes > committed_) {
            commit_more(bytes);
        }
    }

    [[nodiscard]] std::byte* data() const { return data_; }
    [[nodiscard]] std::size_t committed() const { return committed_; }
    [[nodiscard]] std::size_t reserved() const { return reserved_; }

  private:
    void commit_more(std::size_t bytes);
    void release();

    std::byte* data_ = nullptr;
    std::size_t committed_ = 0;
    std::size_t reserved_ = 0;
};

/// Blocks of 4, 8, 16, 32 and 64 KiB, page aligned, reused through a free list a size.
class BlockPool {
  public:
    static constexpr std::size_t kSmallest = 4 * 1024;
    static constexpr std::size_t kLargest = 64 * 1024;

    /// A block of `bytes`, which must be one of the five sizes. Its contents are arbitrary.
    [[nodiscard]] std::byte* allocate(std::size_t bytes);
    void free(std::byte* block, std::size_t bytes);

    [[nodiscard]] std::size_t committed() const { return range_.committed(); }
    [[nodiscard]] std::size_t used() const { return used_; }

  private:
    static constexpr int kSizes = 5;
    static constexpr std::size_t kReserve = std::size_t{1} << 32;
    VirtualRange range_;
    std::size_t end_ = 0;
    std::size_t used_ = 0;
    std::vector<std::byte*> free_[kSizes];
};

}  // namespace limn
