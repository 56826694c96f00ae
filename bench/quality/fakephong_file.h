#pragma once

#include "bench/fakephong/phong_scene.h"
#include "bench/quality/quality.h"

#include <string>

namespace limn {

class World;

namespace fakephong {

/// All triangles of a world's meshes, at rest and in world space, seen from the front under a point
/// light at 2.3 times their radius. Fails if none has an area.
[[nodiscard]] Result<PhongScene> scene_of_world(const World& world, const std::string& name);

}  // namespace fakephong

/// `limn quality fakephong FILE`: every method on the triangles of a glTF or Wavefront file. Time
/// and memory are linear in the number of triangles: a million take 5 s of processor time. Sample
/// points are checked on at most kMaxCheckedFacets.
[[nodiscard]] Status measure_fakephong_file(const std::string& path, QualityReport& report);

}  // namespace limn
