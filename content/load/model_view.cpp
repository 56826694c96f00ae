#include "content/load/model_view.h"

#include "content/load/files/image_load.h"
#include "content/load/gltf/gltf_scene.h"
#include "content/load/model_ground.h"
#include "content/load/scene_bounds.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/environment.h"
#include "ecs/components/framing.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/post.h"
#include "ecs/components/shadow.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

namespace limn {
namespace {

constexpr float kFovY = radians(35.0f);  // like a portrait lens: little distortion
constexpr float kAspect = 16.0f / 9.0f;  // of the image for which the distance is chosen

/// Illuminance [lx] at which exposure 0 shows white surfaces just below the shoulder of the
/// neutral tone curve.
constexpr float kReferenceLux = 2.4f;
constexpr float kNoLight = 1e-6f;  // [lx]
constexpr float kMinReflectance = 0.08f;
/// The studio around lights of kReferenceLux: weak enough that they define the form.
constexpr float kStudioIntensity = 0.32f;
constexpr float kMaxStudioIntensity = 2000.0f;  // its lamps stay within half floats
constexpr float kNearPlane = 0.005f;            // of the subject's radius
constexpr float kShadowDistance = 14.0f;        // of the subject's radius, from the camera
constexpr int kShadowedLights = 4;

constexpr std::array<std::string_view, 4> kBackdrops = {"studio", "sky", "gray", "black"};

float luminance(const Vec3& color) {
    return glm::dot(color, Vec3(0.2126f, 0.7152f, 0.0722f));
}

/// Illuminance at `distance` of an intensity of 1 cd, clamped within a tenth of the subject's
/// radius.
float falloff_at(float distance, float nearest, float radius) {
    const float d = std::max(distance, nearest);
    const float window =
        radius > 0 ? square(std::clamp(1 - square(square(d / radius)), 0.0f, 1.0f)) : 1;
    return window / square(d);
}

float cone_at(const SpotLight& light, float cosine) {
    const float outer = std::cos(light.outer_angle);
    const float inner = std::max(std::cos(light.inner_angle), outer + 1e-4f);
    return std::clamp((cosine - outer) / (inner - outer), 0.0f, 1.0f);
}

/// The enabled lights of a scene, by their illuminance at a point.
class LightMeter {
  public:
    LightMeter(World& world, const Bounds& subject) : matrices_(world) {
        const Bounds box = is_empty(subject) ? Bounds{Vec3(-0.5f), Vec3(0.5f)} : subject;
        nearest_ = 0.1f * std::max(glm::length(half_extent(box)), 1e-6f);
        points_.push_back(center(box));
        for (int axis = 0; axis < 3; ++axis) {
            for (const float side : {-0.7f, 0.7f}) {
                Vec3 p = center(box);
                p[axis] += side * half_extent(box)[axis];
                points_.push_back(p);
            }
        }
        world.query<const DirectionalLight>().each([&](Entity e, const DirectionalLight& light) {
            add(e, light.enabled, luminance(light.color) * light.illuminance);
        });
        world.query<const PointLight>().each([&](Entity entity, const PointLight& light) {
            const Vec3 from = position_of(entity);
            float sum = 0;
            for (const Vec3& p : points_) {
                sum += falloff_at(glm::length(p - from), nearest_, light.radius);
            }
            add(entity, light.enabled, luminance(light.color) * light.intensity * mean(sum));
        });
        world.query<const SpotLight>().each([&](Entity entity, const SpotLight& light) {
            const Vec3 from = position_of(entity);
            const Vec3 axis =
                normalize_or(transform_point(matrices_.of(entity), {0, 0, -1}) - from, {0, 0, -1});
            float sum = 0;
            for (const Vec3& p : points_) {
                const float cosine = glm::dot(normalize_or(p - from, axis), axis);
                sum += cone_at(light, cosine)
                       * falloff_at(glm::length(p - from), nearest_, light.radius);
            }
            add(entity, light.enabled, luminance(light.color) * light.intensity * mean(sum));
        });
    }

    struct Reading {
        Entity light;
        float lux = 0;
    };
    /// Brightest first.
    [[nodiscard]] std::vector<Reading> sorted() const {
        std::vector<Reading> copy = readings_;
        std::stable_sort(copy.begin(), copy.end(), [](const Reading& a, const Reading& b) {
            return a.lux > b.lux;
        });
        return copy;
    }
    [[nodiscard]] float total() const {
        float sum = 0;
        for (const Reading& reading : readings_) {
            sum += reading.lux;
        }
        return sum;
    }

  private:
    void add(Entity light, bool enabled, float lux) {
        if (enabled && std::isfinite(lux)) {
            readings_.push_back({light, lux});
        }
    }
    [[nodiscard]] Vec3 position_of(Entity entity) const {
        return transform_point(matrices_.of(entity), {0, 0, 0});
    }
    [[nodiscard]] float mean(float sum) const { return sum / static_cast<float>(points_.size()); }

    SceneMatrices matrices_;
    std::vector<Vec3> points_;  ///< within the subject
    float nearest_ = 0;         ///< [m]
    std::vector<Reading> readings_;
};

Shadow shadow_for(float radius) {
    return {
        .filter = ShadowFilter::ContactHardening,
        .resolution = 2048,
        .source_size = 0.12f,
        .cascades = 2,
        .distance = kShadowDistance * radius};
}

/// Flatness of `subject`: 1 without height, 0 from a height of 0.4 of its width.
float flatness(const Bounds& subject) {
    const Vec3 half = half_extent(subject);
    const float width = std::max(half.x, half.z);
    return is_empty(subject) || width <= 0 ? 0 : 1 - std::min(half.y / (0.4f * width), 1.0f);
}

/// A warm key from the upper right, where the studio has its large soft box, and a rim light from
/// behind on the left that separates the model from the backdrop; the studio itself fills. The key
/// grazes flat subjects to show their relief.
void add_studio_lights(World& world, const Quat& camera, float radius, ModelView& view) {
    struct RigLight {
        const char* name;
        Vec3 from;  ///< camera space: right, up, toward the camera
        Vec3 color;
        float illuminance;
    };
    const Vec3 key =
        glm::mix(Vec3(0.66f, 0.6f, 0.7f), Vec3(0.92f, 0.22f, 0.3f), flatness(view.subject));
    const RigLight rig[] = {
        {"key light", key, {1.0f, 0.95f, 0.88f}, kReferenceLux},
        {"rim light", {-0.8f, 0.5f, -0.75f}, {0.88f, 0.94f, 1.0f}, 1.3f}};
    for (const RigLight& light : rig) {
        Transform transform;
        transform.rotation = look_along(camera * -light.from);
        const Entity entity = world.create(
            Name{light.name}, transform,
            DirectionalLight{.color = light.color, .illuminance = light.illuminance});
        if (light.from.z > 0) {
            world.add(entity, shadow_for(radius));
        }
        view.added.push_back(entity);
    }
}

/// One sun from the upper right of the camera.
void add_sun(World& world, const Quat& camera, float radius, ModelView& view) {
    Transform transform;
    transform.rotation = look_along(camera * Vec3(-0.6f, -0.8f, -0.5f));
    const Entity sun = world.create(
        Name{"sun"}, transform,
        DirectionalLight{.color = {1.0f, 0.95f, 0.88f}, .illuminance = kReferenceLux},
        shadow_for(radius));
    world.get<Shadow>(sun).source_size = 0.02f;
    view.added.push_back(sun);
}

/// Whether the model speaks or performs a take (speak_command.h): it is looked in the face.
bool is_speaking(const World& world) {
    const std::vector<ClipData>& clips = world.resource<Assets>().clips;
    return !clips.empty() && (clips[0].name == "speech" || clips[0].name == "take");
}

/// frame_bounds; from the front, slightly above, if it speaks.
Framing frame_model(const World& world, const Bounds& subject, bool turns) {
    Framing framing = frame_bounds(subject, kFovY, kAspect, turns);
    if (!turns && is_speaking(world)) {
        const Vec3 middle = is_empty(subject) ? Vec3(0) : center(subject);
        const float distance = glm::distance(framing.camera.position, middle);
        const Vec3 front = glm::normalize(Vec3(0.08f, 0.05f, 1.0f));  // by eye
        framing.camera.position = middle + distance * front;
        framing.camera.rotation = look_along(-front);
    }
    return framing;
}

/// The framing camera, on a turning pivot if it has a turntable.
void add_model_camera(World& world, double turntable, ModelView& view) {
    Camera camera{.fov_y = kFovY};
    const float size = is_empty(view.subject) ? 1.0f : glm::length(half_extent(view.subject));
    camera.near = kNearPlane * size;
    const Framing framing = frame_model(world, view.subject, turntable > 0);
    const FramingState state = {framing.aspect};
    Transform position = framing.camera;
    if (turntable <= 0) {
        view.camera = world.create(Name{"framing camera"}, position, camera, state);
        view.added.push_back(view.camera);
        return;
    }
    const Vec3 pivot_position = is_empty(view.subject) ? Vec3(0) : center(view.subject);
    const float speed = 2 * kPi / static_cast<float>(turntable);
    const Entity pivot = world.create(
        Name{"turntable"}, Transform{.position = pivot_position}, Spin{.speed = speed});
    position.position -= pivot_position;
    view.camera = world.create(Name{"framing camera"}, position, camera, state, Parent{pivot});
    view.added.insert(view.added.end(), {pivot, view.camera});
}

/// Mean luminance of an equirectangular image over the sphere [cd/m^2].
float mean_luminance(const ImageData& image) {
    double sum = 0;
    double weights = 0;
    const bool full = image.format == PixelFormat::Rgba32F;
    for (int y = 0; y < image.height; ++y) {
        const double weight = std::sin((y + 0.5) / image.height * static_cast<double>(kPi));
        for (int x = 0; x < image.width; ++x) {
            const std::size_t i = 4 * (static_cast<std::size_t>(y) * image.width + x);
            Vec3 color;
            for (std::size_t c = 0; c < 3; ++c) {
                if (full) {
                    std::memcpy(&color[static_cast<int>(c)], &image.pixels[4 * (i + c)], 4);
                } else if (image.format == PixelFormat::Rgba16F) {
                    std::uint16_t bits;
                    std::memcpy(&bits, &image.pixels[2 * (i + c)], 2);
                    color[static_cast<int>(c)] = glm::unpackHalf1x16(bits);
                } else {
                    color[static_cast<int>(c)] =
                        std::pow(static_cast<float>(image.pixels[i + c]) / 255.0f, 2.2f);
                }
            }
            sum += weight * static_cast<double>(luminance(color));
            weights += weight;
        }
    }
    return static_cast<float>(sum / weights);
}

/// For light of 2^-manual_ev times kReferenceLux. Metering assumes that the subject reflects at
/// least kMinReflectance, or metal in front of a black backdrop would be overexposed.
Exposure model_exposure(float manual_ev) {
    manual_ev = std::clamp(manual_ev, -24.0f, 24.0f);
    const float lux = kReferenceLux * std::exp2(-manual_ev);
    return {
        .curve = ToneCurve::Neutral,
        .manual_ev = manual_ev,
        .meter_surfaces = true,
        .min_luminance = std::clamp(kMinReflectance * lux / kPi, 1e-6f, 65504.0f)};
}

/// The light of the panorama alone.
void add_panorama(World& world, ImageData panorama) {
    const float illuminance = kPi * mean_luminance(panorama);
    auto& assets = world.resource<Assets>();
    const ImageId id = {static_cast<std::uint32_t>(assets.images.size())};
    assets.images.push_back(std::move(panorama));
    world.insert_resource(Environment{.sky = SkyKind::Panorama, .panorama = id});
    const float ev = illuminance > kNoLight ? std::log2(kReferenceLux / illuminance) : 0.0f;
    world.insert_resource(model_exposure(ev));
}

/// The environment of a named backdrop around light of kReferenceLux.
Environment backdrop_environment(std::string_view name) {
    if (name == "sky") {
        return {.sky = SkyKind::Gradient, .intensity = 0.8f};
    }
    if (name == "gray") {
        return {.sky = SkyKind::Uniform, .zenith = Vec3(0.25f)};
    }
    return {.sky = SkyKind::Studio, .intensity = kStudioIntensity, .visible = name != "black"};
}

}  // namespace

float find_illuminance(World& world, const Bounds& subject) {
    return LightMeter(world, subject).total();
}

Result<Backdrop> load_backdrop(const std::string& name) {
    if (std::find(kBackdrops.begin(), kBackdrops.end(), name) != kBackdrops.end()) {
        return Backdrop{.name = name};
    }
    const bool is_path = name.find_first_of("./") != std::string::npos;
    if (!is_path && !std::filesystem::exists(name)) {
        return fail(
            "--backdrop: found \"{}\", expected {} or an image file", name,
            "studio, sky, gray, black");
    }
    ImageData panorama = LIMN_TRY(load_image(name, true));
    if (const std::size_t bad = replace_non_finite(panorama); bad > 0) {
        log_warn("{}: {} values are not finite; NaN became 0, infinity 65504", name, bad);
    }
    return Backdrop{.name = name, .panorama = std::move(panorama)};
}

ModelView add_model_view(World& world, Backdrop backdrop, double turntable) {
    ModelView view;
    std::vector<Entity> drawn;
    const std::vector<Bounds> boxes = find_boxes(world, SceneMatrices(world), &drawn);
    const std::vector<bool> is_scenery = find_scenery(boxes);
    std::vector<Entity> scenery;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (is_scenery[i]) {
            scenery.push_back(drawn[i]);
        } else {
            grow(view.subject, boxes[i]);
        }
    }
    const float radius = is_empty(view.subject) ? 1.0f : glm::length(half_extent(view.subject));
    const LightMeter meter(world, view.subject);
    const float lux = meter.total();
    add_model_camera(world, turntable, view);
    if (backdrop.panorama) {
        add_panorama(world, *std::move(backdrop.panorama));
    } else {
        Environment environment = backdrop_environment(backdrop.name);
        if (environment.sky
            == SkyKind::Studio) {  // its ceiling would wash out the relief of flat subjects
            environment.intensity *= 1 - 0.6f * flatness(view.subject);
        }
        float ev = 0;
        if (lux > kNoLight) {
            ev = std::clamp(std::log2(kReferenceLux / lux), -24.0f, 24.0f);
            environment.intensity =
                std::min(environment.intensity * std::exp2(-ev), kMaxStudioIntensity);
        }
        world.insert_resource(environment);
        world.insert_resource(model_exposure(ev));
        const Quat rotation = frame_model(world, view.subject, false).camera.rotation;
        if (lux <= kNoLight && backdrop.name == "sky") {
            add_sun(world, rotation, radius, view);
        } else if (lux <= kNoLight) {
            add_studio_lights(world, rotation, radius, view);
        }
    }
    const std::vector<LightMeter::Reading> readings = meter.sorted();
    for (std::size_t i = 0; i < std::min<std::size_t>(readings.size(), kShadowedLights); ++i) {
        if (readings[i].lux > 0 && !world.has<Shadow>(readings[i].light)) {
            Shadow shadow = shadow_for(radius);
            const bool sun = world.has<DirectionalLight>(readings[i].light);
            shadow.source_size = sun ? 0.01f : 0.05f * radius;
            shadow.resolution = sun ? 2048 : 512;
            world.add(readings[i].light, shadow);
        }
    }
    if (scenery.empty() && !is_empty(view.subject)) {
        add_ground(world, view);
    }
    fade_grounds(world, scenery, view);
    return view;
}

}  // namespace limn
