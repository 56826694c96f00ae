#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn {

// Memory that never moves. A VirtualRange reserves a large piece of address space, which is free,
// and commits memory from its front as needed; so a column of an archetype grows without copies and
// its base pointer is valid as long as the archetype. Small archetypes would waste a page per
// column: each uses one block of a BlockPool for all columns, until it outgrows the largest size.
//
// Large ranges get huge pages (2 MiB): faulting one in costs a seventh of the same size in small
// pages, and random access rarely misses the TLB. Since huge pages are aligned, all columns would
// start at the same offset modulo 2 MiB, that is, in the same cache set and memory bank; therefore
// each range is offset by a different skew.

/// Skews are below this. [bytes]
inline constexpr std::size_t kSkewRange = std::size_t{256} << 10;

/// Skew for range number `position` of those used together: successive skews are several pages and
/// an odd number of cache lines apart, so that no two of 4096 are equal. A multiple of `align`, a
/// power of two from 64 to 4096. [bytes]
[[nodiscard]] constexpr std::size_t skew_of(std::size_t position, std::size_t align = 64) {
    const std::size_t skew = position * (5 * 4096 + 39 * 64);
    return (skew + align - 1) / align * align % kSkewRange;
}

/// A reserved range of addresses whose front is readable and writable memory, zero at first.
class VirtualRange {
  public:
    VirtualRange() = default;
    /// Reserves at least `bytes`, starting `skew` past a page boundary; `expected` is how much will
    /// be committed first. Reserves less, with one warning, where address space is limited
    /// (`ulimit -v`); stops the program if none is left.
    explicit VirtualRange(std::size_t bytes, std::size_t skew = 0, std::size_t expected = 0);
    VirtualRange(VirtualRange&& other) noexcept;
    VirtualRange& operator=(VirtualRange&& other) noexcept;
    VirtualRange(const VirtualRange&) = delete;
    VirtualRange& operator=(const VirtualRange&) = delete;
    ~VirtualRange();

    /// Makes at least the first `bytes` usable: steps grow from 64 KiB to 256 KiB, and are whole
    /// huge pages from about 512 KiB on. Stops the program if the reservation or memory is
    /// exhausted.
    void commit(std::size_t bytes) {
        if (bytes > usable_) {
            commit_more(bytes);
        }
    }

    /// Releases memory beyond the first `bytes`, whose contents stay.
    void shrink(std::size_t bytes);

    [[nodiscard]] std::byte* data() const { return data_; }
    /// How much can be used without commit(). [bytes]
    [[nodiscard]] std::size_t usable() const { return usable_; }
    /// Committed memory: the usable part and the skew before it. [bytes]
    [[nodiscard]] std::size_t committed() const { return usable_ > 0 ? lead_ + usable_ : 0; }
    [[nodiscard]] std::size_t reserved() const { return reserved_; }

  private:
    void commit_more(std::size_t bytes);
    void release();

    std::byte* data_ = nullptr;
    std::size_t usable_ = 0;
    std::size_t reserved_ = 0;
    std::size_t lead_ = 0;  ///< before data_, committed with it
};

/// Requests huge pages for memory that is about to be filled for the first time.
void advise_huge_pages(const std::byte* first, std::size_t size);

/// Blocks of 4, 8, 16, 32 and 64 KiB, page aligned, reused through one free list per size.
class BlockPool {
  public:
    static constexpr std::size_t kSmallest = 4 * 1024;
    static constexpr std::size_t kLargest = 64 * 1024;

    /// A block of `bytes`, which must be one of the five sizes. Its contents are unspecified.
    [[nodiscard]] std::byte* allocate(std::size_t bytes);
    void free(std::byte* block, std::size_t bytes);
    /// Releases memory beyond the last block in use.
    void shrink();

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
