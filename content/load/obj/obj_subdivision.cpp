#include "content/load/obj/obj_subdivision.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace limn {

namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

Pair pair_of(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

struct CageEdge {
    std::vector<std::uint32_t> faces;
    bool split = false;
    std::uint32_t point = 0;  ///< in its middle, if it is split
};

struct CageVertex {
    std::vector<std::uint32_t> faces;
    std::vector<Pair> edges;
    bool moves = false;
};

class Subdivision {
  public:
    Subdivision(ObjFile& obj, std::span<const char> chosen) : obj_(obj), chosen_(chosen) {
        vertices_.resize(obj.positions.size());
        for (std::uint32_t f = 0; f < obj.faces.size(); ++f) {
            const std::uint32_t count = obj.faces[f].count;
            for (std::uint32_t k = 0; k < count; ++k) {
                const std::uint32_t a = corner(f, k).position;
                CageEdge& edge = edges_[pair_of(a, corner(f, k + 1).position)];
                edge.faces.push_back(f);
                edge.split = edge.split || chosen[f] != 0;
                vertices_[a].faces.push_back(f);
                vertices_[a].moves = vertices_[a].moves || chosen[f] != 0;
            }
        }
        for (const auto& [ends, edge] : edges_) {
            vertices_[ends.first].edges.push_back(ends);
            vertices_[ends.second].edges.push_back(ends);
        }
    }

    PointMeans run() {
        for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
            begin_point();
            add_vertex(v);
        }
        for (auto& [ends, edge] : edges_) {
            if (edge.split) {
                edge.point = begin_point();
                add_edge_point(ends, edge);
            }
        }
        for (std::uint32_t f = 0; f < obj_.faces.size(); ++f) {
            chosen_[f] != 0 ? split_face(f) : keep_face(f);
        }
        finish_point();
        obj_.positions = apply_means<Vec3>(means_, obj_.positions);
        obj_.corners = std::move(corners_);
        obj_.faces = std::move(faces_);
        return std::move(means_);
    }

  private:
    [[nodiscard]] const ObjCorner& corner(std::uint32_t f, std::uint32_t k) const {
        const ObjFace& face = obj_.faces[f];
        return obj_.corners[face.first + k % face.count];
    }

    [[nodiscard]] const CageEdge& edge_after(std::uint32_t f, std::uint32_t k) const {
        return edges_.at(pair_of(corner(f, k).position, corner(f, k + 1).position));
    }

    /// The number of the point that add() now belongs to.
    std::uint32_t begin_point() {
        finish_point();
        return points_++;
    }

    void finish_point() {
        if (points_ > 0) {
            for (const auto& [point, weight] : sums_) {
                means_.points.push_back(point);
                means_.weights.push_back(static_cast<float>(weight));
            }
            sums_.clear();
        }
        means_.first.push_back(static_cast<std::uint32_t>(means_.points.size()));
    }

    void add(std::uint32_t vertex, double weight) { sums_[vertex] += weight; }

    void add_face(std::uint32_t f, double weight) {
        const std::uint32_t count = obj_.faces[f].count;
        for (std::uint32_t k = 0; k < count; ++k) {
            add(corner(f, k).position, weight / count);
        }
    }

    void add_vertex(std::uint32_t v) {
        const CageVertex& vertex = vertices_[v];
        const auto is_border = [&](const Pair& e) { return edges_.at(e).faces.size() != 2; };
        const auto borders = std::ranges::count_if(vertex.edges, is_border);
        const bool regular = vertex.edges.size() == vertex.faces.size() + (borders == 2 ? 1 : 0);
        if (!vertex.moves || !regular || (borders != 0 && borders != 2)) {
            add(v, 1);
        } else if (borders == 2) {
            add(v, 0.5);
            for (const Pair& ends : vertex.edges) {
                if (is_border(ends)) {
                    add(ends.first, 0.125);
                    add(ends.second, 0.125);
                }
            }
        } else {
            const auto n = static_cast<double>(vertex.faces.size());
            add(v, (n - 3) / n);
            for (const std::uint32_t f : vertex.faces) {
                add_face(f, 1 / (n * n));
            }
            for (const Pair& ends : vertex.edges) {
                add(ends.first, 1 / (n * n));
                add(ends.second, 1 / (n * n));
            }
        }
    }

    void add_edge_point(const Pair& ends, const CageEdge& edge) {
        const double share = edge.faces.size() == 2 ? 0.25 : 0.5;
        add(ends.first, share);
        add(ends.second, share);
        for (std::size_t i = 0; i < 2 && edge.faces.size() == 2; ++i) {
            add_face(edge.faces[i], 0.25);
        }
    }

    /// Halfway between two texture coordinates; the same for all faces with both.
    std::int32_t middle_uv(std::int32_t a, std::int32_t b) {
        if (a < 0 || b < 0) {
            return -1;
        }
        const Pair key = pair_of(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
        const auto [found, added] =
            uv_middles_.try_emplace(key, static_cast<std::int32_t>(obj_.uvs.size()));
        if (added) {
            const Vec2 middle = 0.5f * (obj_.uvs[key.first] + obj_.uvs[key.second]);
            obj_.uvs.push_back(middle);
        }
        return found->second;
    }

    std::int32_t center_uv(std::uint32_t f) {
        Vec2 sum = Vec2(0);
        const std::uint32_t count = obj_.faces[f].count;
        for (std::uint32_t k = 0; k < count; ++k) {
            const std::int32_t uv = corner(f, k).uv;
            if (uv < 0) {
                return -1;
            }
            sum += obj_.uvs[static_cast<std::size_t>(uv)];
        }
        obj_.uvs.push_back(sum / static_cast<float>(count));
        return static_cast<std::int32_t>(obj_.uvs.size()) - 1;
    }

    ObjCorner edge_corner(std::uint32_t f, std::uint32_t k) {
        return {
            .position = edge_after(f, k).point,
            .uv = middle_uv(corner(f, k).uv, corner(f, k + 1).uv),
            .normal = -1};
    }

    static ObjCorner without_normal(const ObjCorner& from) {
        return {.position = from.position, .uv = from.uv, .normal = -1};
    }

    void append_face(std::uint32_t f, std::span<const ObjCorner> corners) {
        ObjFace face = obj_.faces[f];
        face.first = static_cast<std::uint32_t>(corners_.size());
        face.count = static_cast<std::uint32_t>(corners.size());
        faces_.push_back(face);
        corners_.insert(corners_.end(), corners.begin(), corners.end());
    }

    void split_face(std::uint32_t f) {
        const std::uint32_t count = obj_.faces[f].count;
        const ObjCorner middle = {.position = begin_point(), .uv = center_uv(f), .normal = -1};
        add_face(f, 1);
        for (std::uint32_t k = 0; k < count; ++k) {
            const ObjCorner after = edge_corner(f, k);
            const ObjCorner before = edge_corner(f, k + count - 1);
            append_face(f, std::array{without_normal(corner(f, k)), after, middle, before});
        }
    }

    /// With the points of its split edges as corners; in triangles from the first of those, none of
    /// which has three corners in a line.
    void keep_face(std::uint32_t f) {
        std::vector<ObjCorner> corners;
        std::size_t first_point = 0;
        for (std::uint32_t k = 0; k < obj_.faces[f].count; ++k) {
            corners.push_back(without_normal(corner(f, k)));
            if (edge_after(f, k).split) {
                first_point = first_point == 0 ? corners.size() : first_point;
                corners.push_back(edge_corner(f, k));
            }
        }
        if (first_point == 0) {
            append_face(f, corners);
            return;
        }
        std::rotate(
            corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first_point),
            corners.end());
        for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
            append_face(f, std::array{corners[0], corners[k], corners[k + 1]});
        }
    }

    ObjFile& obj_;
    std::span<const char> chosen_;
    std::vector<CageVertex> vertices_;
    std::map<Pair, CageEdge> edges_;
    PointMeans means_;
    std::uint32_t points_ = 0;
    std::map<std::uint32_t, double> sums_;  ///< of the point that is made
    std::map<Pair, std::int32_t> uv_middles_;
    std::vector<ObjCorner> corners_;
    std::vector<ObjFace> faces_;
};

}  // namespace

PointMeans subdivide_obj(ObjFile& obj, std::span<const char> chosen) {
    LIMN_CHECK(chosen.size() == obj.faces.size());
    return Subdivision(obj, chosen).run();
}

}  // namespace limn
