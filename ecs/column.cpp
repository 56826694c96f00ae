#include "ecs/column.h"

#include "ecs/base/check.h"
#include "ecs/base/log.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>
#include <sys/mman.h>
#include <sys/resource.h>
#include <utility>

namespace limn {

namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::size_t kSmallStep = std::size_t{64} << 10;
/// A range that starts small has this much, minus its skew, before its first huge page. [bytes]
constexpr std::size_t kSmallPart = std::size_t{512} << 10;
static_assert(2 * kSkewRange <= kSmallPart && kSmallPart < kHugePage);

constexpr std::size_t round_up(std::size_t value, std::size_t step) {
    return (value + step - 1) / step * step;
}

std::byte* round_down(std::byte* address, std::size_t step) {
    return address - reinterpret_cast<std::uintptr_t>(address) % step;
}

std::byte* round_up(std::byte* address, std::size_t step) {
    return round_down(address + step - 1, step);
}

/// Where address space is limited (ulimit -v), a range takes a small part of it. [bytes]
std::size_t largest_reservation() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
        return std::numeric_limits<std::size_t>::max();
    }
    return std::max<std::size_t>(limit.rlim_cur / 128, 2 * kHugePage);
}

/// Once per process.
void warn_of_short_space(std::size_t most) {
    static std::atomic<bool> warned = false;
    if (!warned.exchange(true)) {
        log_warn(
            "address space is limited (ulimit -v), so a component may take at most {} MiB per "
            "archetype",
            most >> 20);
    }
}

}  // namespace

VirtualRange::VirtualRange(std::size_t bytes, std::size_t skew, std::size_t expected) {
    LIMN_CHECK(skew < kSkewRange);
    if (const std::size_t most = largest_reservation(); bytes > most) {
        bytes = std::max(most, expected);
        warn_of_short_space(most);
    }
    const bool starts_large = expected >= kHugePage;
    const std::size_t offset = skew + (starts_large ? 0 : kHugePage - kSmallPart);
    const std::size_t size = round_up(offset + std::max(bytes, kPage), kPage);
    // Neither readable nor writable, so it counts against no limit on memory until it is committed.
    const std::size_t enough = size + kHugePage;
    void* address =
        mmap(nullptr, enough, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    LIMN_CHECK_NOTE(address != MAP_FAILED, "no address space left; is it limited (ulimit -v)?");
    std::byte* first = static_cast<std::byte*>(address);
    std::byte* base = round_up(first, kHugePage);
    if (base > first) {
        munmap(first, static_cast<std::size_t>(base - first));
    }
    munmap(base + size, static_cast<std::size_t>(first + enough - (base + size)));
    data_ = base + offset;
    reserved_ = size - offset;
    lead_ = static_cast<std::size_t>(data_ - (starts_large ? base : round_down(data_, kPage)));
}

VirtualRange::VirtualRange(VirtualRange&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), usable_(std::exchange(other.usable_, 0)),
      reserved_(std::exchange(other.reserved_, 0)), lead_(std::exchange(other.lead_, 0)) {}

VirtualRange& VirtualRange::operator=(VirtualRange&& other) noexcept {
    if (this != &other) {
        release();
        data_ = std::exchange(other.data_, nullptr);
        usable_ = std::exchange(other.usable_, 0);
        reserved_ = std::exchange(other.reserved_, 0);
        lead_ = std::exchange(other.lead_, 0);
    }
    return *this;
}

VirtualRange::~VirtualRange() {
    release();
}

void VirtualRange::release() {
    if (data_ != nullptr) {
        std::byte* base = round_down(data_, kHugePage);
        munmap(base, static_cast<std::size_t>(data_ + reserved_ - base));
    }
}

void VirtualRange::commit_more(std::size_t bytes) {
    LIMN_CHECK_NOTE(
        bytes <= reserved_,
        "more rows than an archetype can hold; fewer where address space is limited (ulimit -v)");
    const std::size_t step = std::max(std::bit_ceil(usable_ + 1) / 2, kSmallStep);
    std::byte* begin = usable_ == 0 ? data_ - lead_ : data_ + usable_;
    std::byte* end = round_up(data_ + round_up(bytes, step), kPage);
    if (usable_ > 0 && end > round_up(data_, kHugePage)) {
        end = round_up(data_ + bytes, kHugePage);
    }
    end = std::min(end, data_ + reserved_);
    const std::size_t added = static_cast<std::size_t>(end - begin);
    LIMN_CHECK_NOTE(mprotect(begin, added, PROT_READ | PROT_WRITE) == 0, "out of memory");
    if (added >= kHugePage) {
        madvise(begin, added, MADV_HUGEPAGE);  // best effort: without huge pages it is only slower
    }
    usable_ = static_cast<std::size_t>(end - data_);
}

void advise_huge_pages(const std::byte* first, std::size_t size) {
    const auto begin = round_up(reinterpret_cast<std::uintptr_t>(first), kHugePage);
    const auto end = (reinterpret_cast<std::uintptr_t>(first) + size) / kHugePage * kHugePage;
    if (begin < end) {
        madvise(
            reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // best effort, as above
    }
}

void VirtualRange::shrink(std::size_t bytes) {
    std::byte* const end = bytes > 0 ? round_up(data_ + bytes, kPage) : data_ - lead_;
    if (usable_ == 0 || end >= data_ + usable_) {
        return;
    }
    const std::size_t removed = static_cast<std::size_t>(data_ + usable_ - end);
    // The address range stays reserved; the memory is released and reads as zero when recommitted.
    madvise(end, removed, MADV_DONTNEED);
    LIMN_CHECK(mprotect(end, removed, PROT_NONE) == 0);
    usable_ = bytes > 0 ? static_cast<std::size_t>(end - data_) : 0;
}

namespace {

int size_class(std::size_t bytes) {
    LIMN_CHECK(
        std::has_single_bit(bytes) && bytes >= BlockPool::kSmallest
        && bytes <= BlockPool::kLargest);
    return std::countr_zero(bytes) - std::countr_zero(BlockPool::kSmallest);
}

}  // namespace

std::byte* BlockPool::allocate(std::size_t bytes) {
    std::vector<std::byte*>& free = free_[size_class(bytes)];
    used_ += bytes;
    if (!free.empty()) {
        std::byte* block = free.back();
        free.pop_back();
        return block;
    }
    if (range_.data() == nullptr) {
        range_ = VirtualRange(kReserve, 0);
    }
    std::byte* block = range_.data() + end_;
    end_ += bytes;
    range_.commit(end_);
    return block;
}

void BlockPool::free(std::byte* block, std::size_t bytes) {
    free_[size_class(bytes)].push_back(block);
    used_ -= bytes;
}

void BlockPool::shrink() {
    bool found = true;
    while (found && end_ > 0) {
        found = false;
        for (int size = 0; size < kSizes && !found; ++size) {
            const std::size_t bytes = kSmallest << size;
            if (bytes <= end_ && std::erase(free_[size], range_.data() + end_ - bytes) > 0) {
                end_ -= bytes;
                found = true;
            }
        }
    }
    range_.shrink(end_);
}

}  // namespace limn
