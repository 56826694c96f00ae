#pragma once

#include "ecs/base/math.h"

#include <array>
#include <cstdint>
#include <vector>

namespace limn {

// Which vertices the skin of a head has and how quads connect them. kHeadColumns columns run around
// the head, column 0 down the middle of the face, then to the left; kHeadRows rows of quads from
// the rim of the crown to the end of the neck. A square cap closes the crown: its corners are poles
// of valence 3. A block of the grid around each eye, nostril and ear and the mouth is replaced by
// loops of as many vertices as the block has on its border: its corners become poles of valence 5.

inline constexpr int kHeadColumns = 96;
inline constexpr int kHeadRows = 86;

enum class HeadLoops : std::uint8_t { None, Eye, Nostril, Mouth, Ear };

struct HeadVertex {
    Vec3 start = {};  ///< where it begins, before it is wrapped [cm]
    Vec2 chart = {};  ///< column and row, fractions within loops; the cap: row < 0
    HeadLoops loops = HeadLoops::None;  ///< it lies inside of
    std::int16_t loop = 0;              ///< from 1 beside the border of the block inwards
    float angle = 0;                    ///< along the loop: 0 lateral, pi / 2 up [rad]
    bool left = true;                   ///< x >= 0
};

struct HeadLayout {
    std::vector<HeadVertex> vertices;
    std::vector<std::array<std::uint32_t, 4>> quads;  ///< counter-clockwise seen from outside
    std::vector<std::uint32_t> mirror;                ///< of each vertex; its own on x = 0
    int rows = kHeadRows;                             ///< to the ring where it ends
};

/// Loops of each kind, and which of them is the border of the opening.
inline constexpr int kEyeLoops = 14;
inline constexpr int kLidLoop = 9;  ///< outer edge of the lids' margin; the next is the inner edge
inline constexpr int kMouthLoops = 17;
inline constexpr int kLipLoop = 11;  ///< where the lips touch
inline constexpr int kNostrilLoops = 10;
inline constexpr int kNostrilRim = 5;  ///< from there on loops line the cavity
inline constexpr int kEarLoops = 28;

/// With `shoulders`, kShoulderRows follow the end of the neck; what is above has the same indices.
[[nodiscard]] const HeadLayout& head_layout(bool shoulders = false);

}  // namespace limn
