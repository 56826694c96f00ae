#pragma once

#include "ecs/base/math.h"
#include "ecs/components/rendering.h"

#include <array>
#include <string>

namespace limn {

class World;

// What frames cost at each step of the ladder of surface detail (Rendering::surface_detail), while
// a player of a level goes through it.

inline constexpr const char* kDetailLimitTexts[kDetailLimits] = {
    "as the materials say", "relief at most", "parallax occlusion at most",
    "parallax at most",     "normal maps",    "flat"};

/// Whether some material has detail that a limit changes.
[[nodiscard]] bool has_relief(const World& world);

class DetailCosts {
  public:
    /// Call once per frame. `ms`: median of the last second of frames, which are of `size` pixels;
    /// `dt`: real time since the last frame [s].
    void add(DetailLimit limit, double ms, const IVec2& size, float dt);

    /// "relief at most: 41 ns per pixel, 1.7 times flat"; empty while only one step was seen.
    [[nodiscard]] std::string describe() const;

    void forget() { *this = {}; }

  private:
    /// After a change, the median is that of the step before.
    static constexpr float kSettling = 1.2f;

    std::array<double, kDetailLimits> ns_ = {};  ///< per pixel; 0: not measured
    DetailLimit limit_ = DetailLimit::Full;
    float since_ = 0.0f;  ///< the last change [s]
    bool used_ = false;
};

}  // namespace limn
