#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Text files of MakeHuman, for its base mesh hm08. Untrusted: every index and count is checked, and
// an error is one line: "mouth-open.target:12: found X, expected Y".

/// A displacement of one vertex of the base mesh.
struct MakehumanOffset {
    std::uint32_t vertex = 0;
    Vec3 offset = Vec3(0);  ///< [dm]
};

/// A .target file: lines "vertex dx dy dz". Fails on an index >= `vertices`, or a number that is
/// missing, not finite or beyond 1000.
[[nodiscard]] Result<std::vector<MakehumanOffset>>
parse_makehuman_target(std::string_view text, const std::string& file, std::size_t vertices);

/// How a vertex of a proxy (.mhclo) is fitted to the base mesh.
struct MakehumanFit {
    std::array<std::uint32_t, 3> vertices = {};  ///< of the base mesh
    Vec3 weights = Vec3(0);                      ///< of their positions
    Vec3 offset = Vec3(0);                       ///< added, times the proxy's scale [dm]
};

struct MakehumanProxy {
    /// Along x, y and z: two vertices of the base mesh, and their distance when the offsets were
    /// made [dm].
    struct Scale {
        std::array<std::uint32_t, 2> vertices = {};
        float distance = 1;
    };
    std::array<Scale, 3> scales;
    std::vector<MakehumanFit> fits;
};

[[nodiscard]] Result<MakehumanProxy>
parse_makehuman_proxy(std::string_view text, const std::string& file, std::size_t vertices);

/// Positions of the proxy's vertices on the base mesh with these `positions`.
[[nodiscard]] std::vector<Vec3>
fit_proxy(const MakehumanProxy& proxy, std::span<const Vec3> positions);

/// Displacements of the proxy's vertices with those of the base mesh.
[[nodiscard]] std::vector<Vec3>
fit_offsets(const MakehumanProxy& proxy, std::span<const Vec3> offsets);

}  // namespace limn
