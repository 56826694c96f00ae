#include "ecs/column.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <bit>
#include <sys/mman.h>
#include <utility>

namespace limn {

namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kSmallStep = std::size_t{64} << 10;
constexpr std::size_t kLargeStep = std::size_t{2} << 20;  // also the size of a huge page

constexpr std::size_t round_up(std::size_t value, std::size_t step) {
    return (value + step - 1) / step * step;
}

}  // namespace

VirtualRange::VirtualRange(std::size_t bytes) : reserved_(round_up(std::max(bytes, kPage), kPage)) {
    // Neither readable nor writable, so it counts against no limit on memory until it is committed.
    void* address =
        mmap(nullptr, reserved_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    LIMN_CHECK_NOTE(address != MAP_FAILED, "no address space left to reserve");
    data_ = static_cast<std::byte*>(address);
}

VirtualRange::VirtualRange(VirtualRange&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), committed_(std::exchange(other.committed_, 0)),
      reserved_(std::exchange(other.reserved_, 0)) {}

VirtualRange& VirtualRange::operator=(VirtualRange&& other) noexcept {
    if (this != &other) {
        release();
        data_ = std::exchange(other.data_, nullptr);
        committed_ = std::exchange(other.committed_, 0);
        reserved_ = std::exchange(other.reserved_, 0);
    }
    return *this;
}

VirtualRange::~VirtualRange() {
    release();
}

void VirtualRange::release() {
    if (data_ != nullptr) {
        munmap(data_, reserved_);
    }
}

void VirtualRange::commit_more(std::size_t bytes) {
    LIMN_CHECK_NOTE(bytes <= reserved_, "more rows than an archetype can hold");
    const std::size_t step = std::clamp(std::bit_ceil(committed_ + 1) / 2, kSmallStep, kLargeStep);
    const std::size_t target = std::min(round_up(bytes, step), reserved_);
    const int failed = mprotect(data_ + committed_, target - committed_, PROT_READ | PROT_WRITE);
    LIMN_CHECK_NOTE(failed == 0, "out of memory");
    if (target >= 2 * kLargeStep) {
        madvise(data_, target, MADV_HUGEPAGE);  // a wish: without huge pages it is only slower
    }
    committed_ = target;
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
        range_ = VirtualRange(kReserve);
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

}  // namespace limn
