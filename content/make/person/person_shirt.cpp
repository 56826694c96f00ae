#include "content/make/person/person_cloth.h"
#include "content/make/person/person_parts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace limn {

namespace {

constexpr int kHoleColumn = 7;  ///< of the armhole: 6 columns by 4 rows
constexpr int kHoleColumns = 6;
constexpr int kHoleRows = 4;
constexpr float kSleeveBegin = 0.115f;  ///< along the arm [m]

class ShirtBuilder {
  public:
    ShirtBuilder(BodyMesh& mesh, const PersonFrame& frame) : mesh_(mesh), frame_(frame) {}

    void add() {
        const std::vector<float> heights = shirt_rows(frame_);
        const auto under = std::find_if(
            heights.begin(), heights.end(), [](float height) { return height > 1.28f; });
        hole_row_ = static_cast<int>(under - heights.begin());
        for (const float height : heights) {
            rows_.push_back(add_row(height, 0, height));
        }
        for (int r = 0; r + 1 < static_cast<int>(rows_.size()); ++r) {
            join_rows(r);
        }
        add_hem(heights.front());
        add_collar();
        add_sleeve();
    }

  private:
    /// Bands of ribs end a jumper.
    [[nodiscard]] Vec3 row_color(float height) const {
        const bool band = frame_.look.shape.top == PersonTop::Jumper
                          && (height < shirt_hem(frame_) + 0.045f || height > kShirtTop + 0.005f);
        return (band ? 0.86f : 1.0f) * frame_.look.shape.shirt_color;
    }

    /// `grow`: of the section; `at`: the height of its texture coordinate.
    BodyRing add_row(float height, float grow, float at) {
        BodyRing ring;
        ring.closed = false;
        ring.v = 1.5f - at;
        for (int j = 0; j <= kHalfColumns; ++j) {
            BodyVertex vertex;
            vertex.position = shirt_point(frame_, height, cloth_angle(j), grow);
            vertex.color = row_color(height);
            vertex.zone = height < 0.86f ? BodyZone::Skirt : BodyZone::Trunk;
            const bool near_hole = j >= kHoleColumn - 1 && j <= kHoleColumn + kHoleColumns + 1;
            vertex.fair = near_hole && height > 1.27f && height < 1.44f;
            ring.vertices.push_back(mesh_.add(vertex));
        }
        return ring;
    }

    void join_rows(int r) {
        const BodyRing& a = rows_[r];
        const BodyRing& b = rows_[r + 1];
        const bool hole = r >= hole_row_ && r < hole_row_ + kHoleRows;
        for (int j = 0; j < kHalfColumns; ++j) {
            if (hole && j >= kHoleColumn && j < kHoleColumn + kHoleColumns) {
                continue;
            }
            const float u = kClothColumn * static_cast<float>(j);
            mesh_.add_quad(
                {a.vertices[j], b.vertices[j], b.vertices[j + 1], a.vertices[j + 1]},
                {Vec2(u, a.v), Vec2(u, b.v), Vec2(u + kClothColumn, b.v),
                 Vec2(u + kClothColumn, a.v)});
        }
    }

    void add_hem(float hem) {
        const BodyRing fold = add_row(hem, -0.003f, hem - 0.004f);
        const BodyRing inside = add_row(hem + 0.05f, -0.010f, hem - 0.05f);
        mesh_.join(fold, rows_.front(), kClothColumn);
        mesh_.join(inside, fold, kClothColumn);
        mesh_.cap(inside, Vec3(0), kClothColumn, false);
    }

    /// A band around the neck, folded in.
    void add_collar() {
        const BodyRing outer = add_row(1.487f, 0.0042f, 1.487f);
        const BodyRing top = add_row(1.492f, 0.003f, 1.492f);
        const BodyRing inner = add_row(1.489f, 0.0f, 1.496f);
        const BodyRing deep = add_row(1.455f, -0.014f, 1.53f);
        const std::array<const BodyRing*, 5> rings = {&rows_.back(), &outer, &top, &inner, &deep};
        for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
            mesh_.join(*rings[i], *rings[i + 1], kClothColumn);
        }
        mesh_.cap(deep, Vec3(0), kClothColumn, true);
    }

    /// Around the armhole, from the middle of its front up and to the back.
    [[nodiscard]] BodyRing hole() const {
        BodyRing ring;
        const int front = kHoleColumn;
        const int back = kHoleColumn + kHoleColumns;
        const auto at = [&](int row, int column) {
            return rows_[hole_row_ + row].vertices[column];
        };
        for (int row = kHoleRows / 2; row < kHoleRows; ++row) {
            ring.vertices.push_back(at(row, front));
        }
        for (int column = front; column < back; ++column) {
            ring.vertices.push_back(at(kHoleRows, column));
        }
        for (int row = kHoleRows; row > 0; --row) {
            ring.vertices.push_back(at(row, back));
        }
        for (int column = back; column > front; --column) {
            ring.vertices.push_back(at(0, column));
        }
        for (int row = 0; row < kHoleRows / 2; ++row) {
            ring.vertices.push_back(at(row, front));
        }
        return ring;
    }

    [[nodiscard]] Vec2 sleeve_radii(float along, float grow) const {
        const float wrist = frame_.upper_arm_length + frame_.forearm_length;
        const Vec2 arm = arm_radii(frame_, along);
        const float round = 0.5f * (arm.x + arm.y);
        const bool is_long = frame_.look.shape.sleeves == PersonSleeves::Long;
        const float flare = is_long ? 0.0f : 0.010f * glm::smoothstep(kSleeveBegin, 0.22f, along);
        const float loose = is_long ? 0.006f * glm::smoothstep(0.25f, 0.40f, along) : 0.0f;
        const float cuff =
            is_long ? 0.004f * glm::smoothstep(wrist - 0.05f, wrist - 0.03f, along) : 0;
        const float ease = 0.0095f + flare + loose - cuff + grow;
        return glm::mix(arm, Vec2(round), 0.5f) + Vec2(ease);
    }

    BodyRing add_sleeve_ring(float along, float grow) {
        BodyRing ring;
        ring.v = along;
        const Vec2 radii = sleeve_radii(along, grow);
        for (int j = 0; j < kArmColumns; ++j) {
            const float angle = 2 * kPi * static_cast<float>(j) / kArmColumns;
            BodyVertex vertex;
            vertex.position = arm_point(frame_, along, angle, radii);
            vertex.color = frame_.look.shape.shirt_color;
            vertex.zone = BodyZone::Arm;
            vertex.along = along;
            vertex.fair = along <= kSleeveBegin;
            ring.vertices.push_back(mesh_.add(vertex));
        }
        return ring;
    }

    BodyRing add_bridge_ring(const BodyRing& from, const BodyRing& to, float t) {
        BodyRing ring;
        ring.v = std::lerp(-0.02f, to.v, t);
        for (int j = 0; j < kArmColumns; ++j) {
            const Vec3 a = mesh_.vertices[from.vertices[j]].position;
            const Vec3 b = mesh_.vertices[to.vertices[j]].position;
            const float length = glm::distance(a, b);
            const float up = (a.y - 1.36f) / 0.09f;
            const Vec3 out =
                glm::normalize(Vec3(1, std::clamp(0.3f * up, -0.45f, 0.08f), 3 * a.z + 0.04f));
            BodyVertex vertex = mesh_.vertices[from.vertices[j]];
            vertex.position = curve_point(a, length * out, b, length * frame_.upper_arm.along, t);
            vertex.fair = true;
            if (t > 0.7f) {
                vertex.zone = BodyZone::Arm;
                vertex.along = t * to.v;
            }
            ring.vertices.push_back(mesh_.add(vertex));
        }
        return ring;
    }

    void add_sleeve() {
        const float elbow = frame_.upper_arm_length;
        const float wrist = elbow + frame_.forearm_length;
        const BodyRing edge = hole();
        const BodyRing first = add_sleeve_ring(kSleeveBegin, 0);
        const BodyRing one = add_bridge_ring(edge, first, 0.27f);
        const BodyRing two = add_bridge_ring(edge, first, 0.52f);
        const BodyRing three = add_bridge_ring(edge, first, 0.76f);
        std::vector<BodyRing> rings = {edge, one, two, three, first};
        rings[0].v = -0.02f;
        const float end = person_hems(frame_).sleeve;
        for (const float along :
             {0.14f, 0.165f, 0.19f, 0.215f, 0.24f, elbow - 0.03f, elbow - 0.012f, elbow + 0.004f,
              elbow + 0.02f, elbow + 0.038f, elbow + 0.06f, elbow + 0.09f, elbow + 0.12f,
              elbow + 0.15f, elbow + 0.18f, elbow + 0.205f, wrist - 0.034f, wrist - 0.028f, end}) {
            if (along <= end && along > rings.back().v + 0.004f) {
                rings.push_back(add_sleeve_ring(along, 0));
            }
        }
        BodyRing fold = add_sleeve_ring(end, -0.003f);
        fold.v = end + 0.004f;
        BodyRing inside = add_sleeve_ring(end - 0.035f, -0.0075f);
        inside.v = end + 0.05f;
        rings.push_back(fold);
        rings.push_back(inside);
        for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
            mesh_.join(rings[i + 1], rings[i], kClothColumn);
        }
        mesh_.cap(rings.back(), Vec3(0), kClothColumn, false);
    }

    BodyMesh& mesh_;
    const PersonFrame& frame_;
    std::vector<BodyRing> rows_;
    int hole_row_ = 0;
};

}  // namespace

void add_shirt(BodyMesh& mesh, const PersonFrame& frame) {
    ShirtBuilder(mesh, frame).add();
}

}  // namespace limn
