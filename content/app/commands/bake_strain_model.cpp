#include "content/app/commands/bake_strain_model.h"

#include "content/app/commands/bake_command.h"
#include "content/app/commands/image_file.h"
#include "content/app/commands/progress.h"
#include "content/bake/skin_texels.h"
#include "content/bake/tangents.h"
#include "content/bake/wrinkle_model.h"
#include "content/game/game.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/image_load.h"
#include "content/load/files/json_document.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/level/component_json.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

// Techniques: face.wrinkle-model

namespace limn {

struct CapturedShape {
    std::string name;
    float weight = 1;
};

LIMN_FIELDS(CapturedShape) {
    LIMN_FIELD(name, "of a morph target, or its action unit");
    LIMN_FIELD(weight, "in this pose", "", -2, 2);
}

/// An expression and the relief of the skin in it.
struct CapturedPose {
    std::string image;
    std::vector<CapturedShape> shapes;
};

LIMN_FIELDS(CapturedPose) {
    LIMN_FIELD(image, "normal map of 8 bits, green up; file relative to this one");
    LIMN_FIELD(shapes, "morph targets of the face with nonzero weights");
}

struct CapturedPoses {
    std::string face;
    std::string rest;
    std::vector<CapturedPose> poses;
    int uv_set = 0;
    int size = 512;
    int degree = 2;
    float ridge = 1e-4f;
};

LIMN_FIELDS(CapturedPoses) {
    LIMN_FIELD(face, ".gltf or .glb, relative to this file");
    LIMN_FIELD(rest, "normal map at rest, whose slopes are subtracted; none: flat");
    LIMN_FIELD(poses, "at least as many as the polynomial has terms");
    LIMN_FIELD(
        uv_set, "texture coordinates of the maps and tangents: 0, or 1 as in imported faces", "", 0,
        1);
    LIMN_FIELD(size, "texels along each side of the model", "", 1, 1024);
    LIMN_FIELD(degree, "degree of the polynomial: 3, 9 or 19 terms", "", 1, 3);
    LIMN_FIELD(ridge, "regularization of the least-squares fit", "", 1e-8, 1);
}

namespace {

constexpr int kStrainGutter = 4;      ///< [texels]
constexpr float kMinNormalZ = 0.05f;  ///< steeper normals are clamped

/// Slopes of a normal map, averaged over each of size x size texels.
Result<std::vector<Vec2>> load_slopes(const std::string& path, int size) {
    const ImageData image = LIMN_TRY(load_image(path, false));
    if (image.format != PixelFormat::Rgba8) {
        return fail("{}: found floats, expected a normal map of 8 bits", path);
    }
    const auto slope_at = [&](int x, int y) {
        const std::uint8_t* const texel =
            &image.pixels
                 [4
                  * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width)
                     + static_cast<std::size_t>(x))];
        const Vec3 n = (Vec3(texel[0], texel[1], texel[2]) - 128.0f) / 127.0f;
        return Vec2(n) / -std::max(n.z, kMinNormalZ);
    };
    const auto begin_of = [size](int i, int count) {
        return std::min(static_cast<int>(std::int64_t{i} * count / size), count - 1);
    };
    std::vector<Vec2> slopes;
    for (int y = 0; y < size; ++y) {
        const int top = begin_of(y, image.height);
        const int bottom = std::max(begin_of(y + 1, image.height), top + 1);
        for (int x = 0; x < size; ++x) {
            const int left = begin_of(x, image.width);
            const int right = std::max(begin_of(x + 1, image.width), left + 1);
            Vec2 sum = Vec2(0);
            for (int v = top; v < bottom; ++v) {
                for (int u = left; u < right; ++u) {
                    sum += slope_at(u, v);
                }
            }
            slopes.push_back(sum / static_cast<float>((bottom - top) * (right - left)));
        }
    }
    return slopes;
}

/// The mesh with the most morph targets; among equals, the largest.
Result<MeshData> load_face(const std::string& path, int uv_set) {
    register_game_components();
    GltfScene scene = LIMN_TRY(load_gltf(path));
    const auto found = std::ranges::max_element(scene.meshes, {}, [](const MeshData& mesh) {
        return std::pair(mesh.morphs.size(), mesh.positions.size());
    });
    if (found == scene.meshes.end() || found->morphs.empty()) {
        return fail("{}: found no morph targets, expected a face with expressions", path);
    }
    if (uv_set == 1) {
        found->uvs = found->uvs1;
    }
    if (found->uvs.size() != found->positions.size()) {
        return fail(
            "{}: found no texture coordinates {}, expected those of the maps", path, uv_set);
    }
    if (found->tangents.size() != found->positions.size()) {
        generate_tangents(*found);
    }
    return std::move(*found);
}

/// Adds the offsets of all targets of this name, or with this action unit.
Status move_by(
    const MeshData& mesh, const CapturedShape& shape, const std::string& file,
    std::vector<Vec3>& positions) {
    bool found = false;
    std::vector<std::string_view> names;
    for (const MorphTarget& morph : mesh.morphs) {
        names.emplace_back(morph.name);
        if (morph.name != shape.name && (shape.name.empty() || morph.action_unit != shape.name)) {
            continue;
        }
        found = true;
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            positions[morph.vertices[i]] += shape.weight * morph.positions[i];
        }
    }
    if (!found) {
        return fail(
            "{}: found the shape {}, expected a morph target of the face{}", file,
            in_quotes(shape.name), did_you_mean(shape.name, names));
    }
    return Done{};
}

std::vector<float> floats_of(const ImageData& image) {
    std::vector<float> values;
    values.reserve(image.pixels.size() / 2);
    for (std::size_t i = 0; i + 2 <= image.pixels.size(); i += 2) {
        std::uint16_t bits = 0;
        std::memcpy(&bits, &image.pixels[i], sizeof bits);
        values.push_back(glm::unpackHalf1x16(bits));
    }
    return values;
}

}  // namespace

Status bake_strain_model(const BakeOptions& options) {
    if (LIMN_TRY(image_file_kind(options.out)) != ImageFileKind::Exr) {
        return fail("{}: expected a file name ending in .exr", options.out);
    }
    CapturedPoses recipe;
    const JsonValue json = LIMN_TRY(load_json(options.in));
    LIMN_TRY(read_struct(json, recipe, {options.in, ""}, {}));
    if (recipe.poses.empty()) {
        return fail("{}: found 0 poses, expected at least 1", options.in);
    }
    const std::filesystem::path folder = std::filesystem::path(options.in).parent_path();
    const MeshData mesh = LIMN_TRY(load_face((folder / recipe.face).string(), recipe.uv_set));
    const std::vector<SkinTexel> texels = find_skin_texels(mesh, recipe.size, kStrainGutter);
    std::vector<Vec2> rest(texels.size(), Vec2(0));
    if (!recipe.rest.empty()) {
        rest = LIMN_TRY(load_slopes((folder / recipe.rest).string(), recipe.size));
    }

    Progress progress("pose", static_cast<int>(recipe.poses.size()));
    std::vector<WrinklePose> poses;
    for (const CapturedPose& captured : recipe.poses) {
        std::vector<Vec3> positions = mesh.positions;
        for (const CapturedShape& shape : captured.shapes) {
            LIMN_TRY(move_by(mesh, shape, options.in, positions));
        }
        const std::vector<Vec3> strain = find_tangent_strain(mesh, positions);
        WrinklePose& pose = poses.emplace_back();
        pose.slopes = LIMN_TRY(load_slopes((folder / captured.image).string(), recipe.size));
        for (std::size_t i = 0; i < texels.size(); ++i) {
            pose.strain.push_back(at_texel(mesh.indices, texels[i], std::span<const Vec3>(strain)));
            pose.slopes[i] -= rest[i];
        }
        progress.update(static_cast<int>(poses.size()));
    }
    const ImageData model = pack_wrinkle_model(
        fit_wrinkle_model(recipe.size, poses, {.degree = recipe.degree, .ridge = recipe.ridge}));
    ExrImage image = {.width = model.width, .height = model.height};
    add_layer(image, "", "RGBA", floats_of(model), true);
    return write_exr(options.out, image);
}

}  // namespace limn
