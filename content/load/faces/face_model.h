#pragma once

#include "content/load/gltf/gltf_scene.h"
#include "content/load/obj/obj_file.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// A parametric face (wrinkle.compression.face-model): each parameter has one transform and the
// vertices that follow it, by weights of 0 to 1. A text file names the mesh and its parameters:
//
//     mesh face.obj                      # beside this file
//     unit 0.01                          # [m]; default 1
//     parameter jaw                      # 0 at rest, 1 in full; in the order of the file
//     rotate 1 0 0 by 25 about 0 -0.5 2  # axis, angle [degrees], a point of the axis
//     vertex 812 1                       # number in the mesh, from 1, and weight
//     parameter brow
//     translate 0 0.6 0.1
//     ball 2 6 9 2.5                     # center, radius: weights fall smoothly to 0 at the radius
//     parameter nostril
//     scale 1.2 1 1.1 about 0 0 10
//     ball 0 0 10 1
//
// A face whose parameters are p moves a vertex of weight w by each in turn: translated by w p t,
// turned by the angle w p a, scaled by 1 + w p (s - 1). In a scene, parameters are shapes, which
// move vertices along lines: arcs have in-betweens, and pairs of parameters that share vertices
// correctives.

enum class FaceTransform : std::uint8_t { Rotate, Translate, Scale };

struct FaceParameter {
    std::string name;
    FaceTransform transform = FaceTransform::Translate;
    Vec3 vector = {0, 0, 0};  ///< unit axis, offset, or factors
    float angle = 0;          ///< [rad]
    Vec3 pivot = {0, 0, 0};
    std::vector<std::uint32_t> vertices;  ///< each once
    std::vector<float> weights;           ///< one per vertex, > 0 and <= 1
};

struct FaceModel {
    ObjFile mesh;
    float unit = 1;  ///< [m]
    std::vector<FaceParameter> parameters;
};

/// Fails with file and line: an unknown word, a vertex that the mesh lacks, a weight beyond 0 .. 1,
/// a parameter without a transform, a second one of a name.
[[nodiscard]] Result<FaceModel>
parse_face_model(std::string_view text, const std::string& file, ObjFile mesh);

/// The same from a file that names its mesh.
[[nodiscard]] Result<FaceModel> load_face_model(const std::string& path);

/// Positions of the mesh, moved by parameters of these values, one each.
[[nodiscard]] std::vector<Vec3> apply_face_model(const FaceModel& model, std::span<const float> p);

/// One mesh whose first shapes are the parameters.
[[nodiscard]] GltfScene make_face_model_scene(const std::string& name, const FaceModel& model);

}  // namespace limn
