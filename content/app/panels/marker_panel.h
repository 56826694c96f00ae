#pragma once

#include "content/load/faces/face_skin.h"
#include "content/load/faces/marker_retarget.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/entity.h"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace limn {

class World;
struct HudStyle;
struct PanelPointer;
struct Ray;
struct RenderView;

// Shift M: places of the markers of a recording on a face (face.retarget-fit). A marker is chosen
// in the list or in the recording's front view, a click on the face is its place, whatever pose the
// face is in. The file is that of `limn import markers --map`.

/// Where a face is, in world space.
struct FacePlace {
    Vec3 center = {0, 0, 0};
    Vec3 front = {0, 0, 1};  ///< direction that it looks in, unit
    float radius = 1.0f;     ///< of what its shapes move [m]
};

class MarkerPanel {
  public:
    /// Reads the recording, a TRC file, and the map if there is one; "" is the file beside the
    /// recording that ends in .map.
    [[nodiscard]] Status load(const std::string& take, const std::string& map);
    [[nodiscard]] bool has_take() const { return !names_.empty(); }
    [[nodiscard]] bool has_unsaved() const { return unsaved_; }

    /// Shows the skin of `entity` or, if that has no shapes, the one whose shapes move
    /// most vertices. Fails if the world has no face.
    [[nodiscard]] Status open(const World& world, Entity entity);
    void close() { skin_ = {}; }
    /// For a camera before the face; none while the panel is closed.
    [[nodiscard]] std::optional<FacePlace> find_face(const World& world) const;
    [[nodiscard]] bool is_open() const { return !skin_.is_null(); }

    /// Whether a click of this frame placed a marker.
    [[nodiscard]] bool
    take_pointer(const World& world, const RenderView& view, const PanelPointer& pointer);
    void draw_overlay(const RenderView& view, const World& world) const;
    void draw(const HudStyle& style, const World& world);

    /// Message on what was placed, saved or failed since the last call; empty: none.
    [[nodiscard]] std::string take_message() { return std::exchange(message_, {}); }

    // ---- edits, without a window ----

    void select(std::size_t marker) { selected_ = marker; }
    [[nodiscard]] std::size_t selected() const { return selected_; }
    /// Places the selected marker where the ray meets the skin as it is drawn, and selects the next
    /// one without a place. False where it passes by.
    bool place(const World& world, const Ray& ray);
    /// Removes the place of the selected marker from the map.
    void remove_place(const World& world);
    /// Takes the last change back; false: there is none.
    bool undo(const World& world);
    void save();
    [[nodiscard]] const std::vector<FaceMarkerPlace>& places() const { return places_; }
    /// Where a marker is on the skin: by the map, else by its name.
    [[nodiscard]] const std::optional<SkinPoint>& point_of(std::size_t marker) const {
        return points_[marker];
    }

  private:
    [[nodiscard]] const MeshData* skin_mesh(const World& world) const;
    [[nodiscard]] bool is_mapped(std::size_t marker) const;
    void change(const World& world, std::vector<FaceMarkerPlace> places);
    void update_points(const World& world);
    void draw_cloud(const HudStyle& style);
    void draw_list(const HudStyle& style);

    Entity skin_;
    std::string take_;  ///< file
    std::string map_;   ///< file
    std::vector<std::string> names_;
    std::vector<Vec3> rest_;  ///< of the markers in the recording [m]
    std::vector<FaceMarkerPlace> places_;
    std::vector<std::vector<FaceMarkerPlace>> past_;  ///< before each change
    std::vector<std::optional<SkinPoint>> points_;    ///< of the markers, on the skin
    std::size_t selected_ = 0;
    bool unsaved_ = false;
    std::string message_;
};

}  // namespace limn
