#pragma once

#include "systems/motion_kernels.h"

#include <array>
#include <span>
#include <vector>

namespace limn::test {

/// Sways as the kernels read them: an array per scalar.
class SwayTable {
  public:
    explicit SwayTable(std::span<const Sway> sways) {
        for (const Sway& sway : sways) {
            const Vec3 fields[] = {sway.center, sway.amplitude, sway.frequency, sway.phase};
            for (int i = 0; i < 12; ++i) {
                lanes_[i].push_back(fields[i / 3][i % 3]);
            }
        }
    }
    [[nodiscard]] SwayArrays arrays() const {
        const auto axes = [&](int first) {
            return SwayArrays::Axes{lanes_[first], lanes_[first + 1], lanes_[first + 2]};
        };
        return {axes(0), axes(3), axes(6), axes(9)};
    }

  private:
    std::array<std::vector<float>, 12> lanes_;
};

}  // namespace limn::test
