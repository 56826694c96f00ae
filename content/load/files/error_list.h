#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <string>
#include <unordered_set>
#include <vector>

namespace limn {

/// Independent errors of a file, so that one run reports several: the first ten, a line each, and
/// how many more.
class ErrorList {
  public:
    explicit ErrorList(std::string file) : file_(std::move(file)) {}

    /// Keeps one error per location in the file, since a prefab repeats its errors in all
    /// its copies.
    void keep(const Status& status);
    [[nodiscard]] bool empty() const { return lines_.empty(); }
    /// Number of errors given to keep(), including repeated locations.
    [[nodiscard]] std::size_t count() const { return count_; }
    /// Whether further errors are counted.
    [[nodiscard]] bool has_room() const { return locations_.size() < kMaxErrors; }
    /// All of them as one error, or Done.
    [[nodiscard]] Status status() const;

  private:
    static constexpr std::size_t kShownErrors = 10;
    static constexpr std::size_t kMaxErrors = 1000;

    std::string file_;
    std::vector<std::string> lines_;
    std::size_t count_ = 0;
    std::unordered_set<std::string> locations_;  // of all
};

}  // namespace limn
