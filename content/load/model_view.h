#pragma once

#include "content/load/files/load_warnings.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/surface.h"
#include "ecs/entity.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace limn {

class World;

// The view of a single model: a camera that frames it, a studio with a ground or another backdrop,
// lights if none of its own illuminate it, and an exposure for its light, as from a photographer's
// incident light meter: files come without lights, with lights in arbitrary units, or with a sun of
// 100,000 lux.

struct ModelViewOptions {
    std::string backdrop = "studio";  ///< studio, sky, gray, black, or an image: a panorama
    double turntable = 0;             ///< seconds per turn of the camera; 0: fixed
    std::string variant = {};         ///< of the materials of a glTF file; empty: its default
    bool wrinkles = true;             ///< imported faces wrinkle (face_wrinkles.h)
    LoadOptions load = {};            ///< how bad parts of the file are handled
};

/// The background of a model, which also lights it.
struct Backdrop {
    std::string name;
    std::optional<ImageData> panorama = {};
};

/// Fails if `name` is neither a backdrop nor a readable image.
[[nodiscard]] Result<Backdrop> load_backdrop(const std::string& name);

struct ModelView {
    Entity camera;
    Bounds subject;             ///< the framed part, without a ground plane or sky dome of the file
    std::vector<Entity> added;  ///< every entity that does not come from the file
    std::size_t meshes = 0;     ///< added at the end of those of Assets
    std::size_t materials = 0;  ///< likewise
};

/// Sets up the view of everything in `world`, which has the resource Assets. Inserts Environment
/// and Exposure; keeps cameras and lights of the file, but adds shadows to its
/// strongest lights. `turntable`: seconds per turn of the camera; 0: fixed.
[[nodiscard]] ModelView add_model_view(World& world, Backdrop backdrop, double turntable = 0);

/// Illuminance [lx] of surfaces that face the lights of the scene, averaged over points within
/// `subject`; 0 if nothing illuminates it. Needs no step of the simulation.
[[nodiscard]] float find_illuminance(World& world, const Bounds& subject);

}  // namespace limn
