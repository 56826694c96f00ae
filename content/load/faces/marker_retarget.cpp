#include "content/load/faces/marker_retarget.h"

#include "content/bake/point_warp.h"
#include "content/bake/surface_fit.h"
#include "content/load/faces/face_skin.h"
#include "content/load/files/json_document.h"
#include "content/make/head/head.h"
#include "content/make/head/head_markers.h"
#include "ecs/base/check.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>

// Techniques: face.retarget-fit, face.retarget-warp

namespace limn {
namespace {

constexpr float kSameChart = 0.002f;  // between vertices of one place, in texture coordinates
constexpr float kMaxChart = 0.03f;  ///< from a place to the nearest vertex, in texture coordinates
constexpr float kRidge = 4e-3f;     ///< cost of weights, of the square motion of the largest shape
                                    ///< that moves the same markers
constexpr int kSweeps = 40;         ///< of coordinate descent
constexpr float kSettled = 1e-4f;   ///< change of weights in a sweep that ends it

/// A place by its name and a marker of the built-in head: on the midline, or left.
struct NamedPlace {
    std::string_view name;
    std::string_view marker;
    bool has_sides = false;
};

constexpr std::array kPlaces{
    NamedPlace{"forehead", "skin10_0_M"},
    NamedPlace{"foreheadside", "skin10_10_L", true},
    NamedPlace{"glabella", "skin24_0_M"},
    NamedPlace{"browinner", "skin20_4_L", true},
    NamedPlace{"brow", "skin22_7_L", true},
    NamedPlace{"browmiddle", "skin22_7_L", true},
    NamedPlace{"browouter", "skin22_13_L", true},
    NamedPlace{"lidupper", "lid9_90_L", true},
    NamedPlace{"upperlid", "lid9_90_L", true},
    NamedPlace{"lidlower", "lid9_270_L", true},
    NamedPlace{"lowerlid", "lid9_270_L", true},
    NamedPlace{"nosebridge", "skin31_0_M"},
    NamedPlace{"nose", "skin37_0_M"},
    NamedPlace{"nosetip", "skin37_0_M"},
    NamedPlace{"nostril", "skin39_7_L", true},
    NamedPlace{"cheekbone", "skin34_16_L", true},
    NamedPlace{"cheek", "skin39_16_L", true},
    NamedPlace{"cheeklower", "skin44_16_L", true},
    NamedPlace{"nasolabial", "skin43_7_L", true},
    NamedPlace{"upperlip", "mouth9_90_M"},
    NamedPlace{"lipupper", "mouth9_90_M"},
    NamedPlace{"upperlipside", "mouth9_58_L", true},
    NamedPlace{"lowerlip", "mouth9_270_M"},
    NamedPlace{"liplower", "mouth9_270_M"},
    NamedPlace{"lowerlipside", "mouth9_302_L", true},
    NamedPlace{"mouth", "mouth7_0_L", true},
    NamedPlace{"mouthcorner", "mouth7_0_L", true},
    NamedPlace{"lipcorner", "mouth7_0_L", true},
    NamedPlace{"chin", "skin60_0_M"},
    NamedPlace{"chinside", "skin60_5_L", true},
    NamedPlace{"jaw", "skin60_18_L", true},
    NamedPlace{"jawangle", "skin56_25_L", true},
};

/// Lower case, without separators.
std::string normalized(std::string_view name) {
    std::string text;
    for (const char c : name) {
        if (c >= 'A' && c <= 'Z') {
            text.push_back(static_cast<char>(c - 'A' + 'a'));
        } else if (c != '_' && c != '-' && c != '.' && c != ' ' && c != ':') {
            text.push_back(c);
        }
    }
    return text;
}

/// Texture coordinates of a marker of the built-in head.
std::optional<Vec2> chart_of_marker(std::string_view name) {
    static const MeshData surface = make_head({.part = HeadPartKind::Markers});
    const std::vector<std::string>& names = head_markers().names;
    const auto found = std::ranges::find(names, name);
    return found == names.end()
               ? std::nullopt
               : std::optional(surface.uvs[static_cast<std::size_t>(found - names.begin())]);
}

/// Texture coordinates of a place by any of its names.
std::optional<Vec2> chart_of(std::string_view name) {
    if (const std::optional<Vec2> chart = chart_of_marker(name)) {
        return chart;
    }
    const std::string plain = normalized(name);
    for (const NamedPlace& place : kPlaces) {
        if (!place.has_sides) {
            if (plain == place.name) {
                return chart_of_marker(place.marker);
            }
            continue;
        }
        for (const std::string_view side : {"left", "l", "right", "r"}) {
            const std::string before = std::string(side) + std::string(place.name);
            const std::string after = std::string(place.name) + std::string(side);
            if (plain == before || plain == after) {
                std::optional<Vec2> chart = chart_of_marker(place.marker);
                if (chart && side[0] == 'r') {
                    chart->x = 1.0f - chart->x;
                }
                return chart;
            }
        }
    }
    return std::nullopt;
}

/// All names that chart_of knows, with sides.
std::vector<std::string> known_names() {
    std::vector<std::string> names = head_markers().names;
    for (const NamedPlace& place : kPlaces) {
        if (place.has_sides) {
            for (const char* const before : {"left_", "right_"}) {
                names.push_back(before + std::string(place.name));
            }
            for (const char* const after : {"L", "R", "_L", "_R"}) {
                names.push_back(std::string(place.name) + after);
            }
        } else {
            names.emplace_back(place.name);
        }
    }
    return names;
}

std::string nearest_name(const std::string& name) {
    const std::vector<std::string> names = known_names();
    return in_quotes(name)
           + did_you_mean(name, std::vector<std::string_view>(names.begin(), names.end()));
}

/// Nearest vertex by texture coordinates, or none; of those about as near the foremost, since gums
/// and teeth may lie behind lips.
std::optional<std::uint32_t> vertex_at(const MeshData& skin, const Vec2& chart) {
    const std::vector<Vec2>& uvs = skin.uvs1.empty() ? skin.uvs : skin.uvs1;
    float distance = kMaxChart;
    for (const Vec2& uv : uvs) {
        distance = std::min(distance, glm::distance(uv, chart));
    }
    std::optional<std::uint32_t> found;
    for (std::uint32_t v = 0; v < uvs.size() && distance < kMaxChart; ++v) {
        if (glm::distance(uvs[v], chart) <= distance + kSameChart
            && (!found || skin.positions[v].z > skin.positions[*found].z)) {
            found = v;
        }
    }
    return found;
}

/// Sums of the squared motion of all markers, for each shape.
std::vector<float> squares_of(std::span<const std::vector<Vec3>> moves) {
    std::vector<float> squares;
    for (const std::vector<Vec3>& shape : moves) {
        float& sum = squares.emplace_back(0.0f);
        for (const Vec3& move : shape) {
            sum += glm::dot(move, move);
        }
    }
    return squares;
}

/// A share of the square motion of the largest other shape, by how far both move the same markers.
std::vector<float> cost_of_weights(std::span<const std::vector<Vec3>> moves) {
    const std::vector<float> squares = squares_of(moves);
    std::vector<float> costs(moves.size(), 0.0f);
    for (std::size_t s = 0; s < moves.size(); ++s) {
        for (std::size_t t = 0; t < moves.size() && squares[s] > 0.0f; ++t) {
            float common = 0.0f;
            for (std::size_t m = 0; m < moves[s].size(); ++m) {
                common += glm::length(moves[s][m]) * glm::length(moves[t][m]);
            }
            costs[s] = std::max(costs[s], kRidge * common * common / squares[s]);
        }
    }
    return costs;
}

/// Root of the mean squared distance from the mean of some points.
float size_of(std::span<const Vec3> points) {
    Vec3 mean(0);
    for (const Vec3& p : points) {
        mean += p / static_cast<float>(points.size());
    }
    float sum = 0.0f;
    for (const Vec3& p : points) {
        sum += glm::dot(p - mean, p - mean);
    }
    return std::sqrt(sum / static_cast<float>(points.size()));
}

}  // namespace

Result<std::vector<FaceMarkerPlace>>
parse_marker_map(std::string_view text, const std::string& file) {
    std::vector<FaceMarkerPlace> places;
    if (text.starts_with("\xef\xbb\xbf")) {
        text.remove_prefix(3);  // byte order mark
    }
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string row(text.substr(0, std::min(end, text.find('#'))));
        text.remove_prefix(std::min(end + 1, text.size()));
        const auto trimmed = [](std::string part) {
            part.erase(0, part.find_first_not_of(" \t\r"));
            part.erase(part.find_last_not_of(" \t\r") + 1);
            return part;
        };
        row = trimmed(row);
        if (row.empty()) {
            continue;
        }
        const std::size_t equals = row.find('=');
        FaceMarkerPlace place;
        place.line = line;
        place.marker = trimmed(row.substr(0, equals));
        place.place = equals == std::string::npos ? "" : trimmed(row.substr(equals + 1));
        if (place.marker.empty() || place.place.empty()) {
            return fail(
                "{}:{}: found {}, expected \"marker = x y z\" or \"marker = place\"", file, line,
                in_quotes(row));
        }
        char* rest = place.place.data();
        int numbers = 0;
        for (; numbers < 3; ++numbers) {
            char* const start = rest;
            place.point[numbers] = std::strtof(start, &rest);
            if (rest == start) {
                break;
            }
        }
        const bool is_point = numbers == 3 && *rest == '\0' && is_finite(place.point);
        if (numbers > 0 && !is_point) {
            return fail(
                "{}:{}: found {}, expected three numbers or a place", file, line,
                in_quotes(place.place));
        }
        place.place = is_point ? "" : place.place;
        places.push_back(std::move(place));
    }
    return places;
}

std::string write_marker_map(std::string_view text, std::span<const FaceMarkerPlace> places) {
    const auto line_of = [](const FaceMarkerPlace& place) {
        std::string line = place.marker + " =";
        for (int axis = 0; axis < 3 && place.place.empty(); ++axis) {
            line += " " + fixed_text(static_cast<double>(place.point[axis]), 6);
        }
        return place.place.empty() ? line : line + " " + place.place;
    };
    std::string written;
    std::vector<bool> done(places.size(), false);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view row = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const auto parsed = parse_marker_map(row, {});
        if (parsed && parsed->empty()) {
            written += std::string(row) + '\n';
            continue;
        }
        const auto found =
            parsed ? std::ranges::find(places, parsed->front().marker, &FaceMarkerPlace::marker)
                   : places.end();
        if (found == places.end()) {
            continue;
        }
        const bool is_same = line_of(*found) == line_of(parsed->front());
        written += (is_same ? std::string(row) : line_of(*found)) + '\n';
        done[static_cast<std::size_t>(found - places.begin())] = true;
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
        written += done[i] ? std::string() : line_of(places[i]) + '\n';
    }
    return written;
}

std::optional<Vec3> find_named_place(const MeshData& skin, std::string_view name) {
    const std::optional<Vec2> chart = chart_of(name);
    const auto vertex = chart ? vertex_at(skin, *chart) : std::nullopt;
    return vertex ? std::optional(skin.positions[*vertex]) : std::nullopt;
}

std::vector<std::string_view> place_names() {
    std::vector<std::string_view> names;
    for (const NamedPlace& place : kPlaces) {
        names.push_back(place.name);
    }
    return names;
}

Status check_marker_map(
    std::span<const std::string> markers, std::span<const FaceMarkerPlace> map,
    const std::string& file) {
    std::vector<std::string> wrong;
    for (const FaceMarkerPlace& place : map) {
        if (std::ranges::find(markers, place.marker) == markers.end()) {
            wrong.push_back(
                in_quotes(place.marker)
                + did_you_mean(
                    place.marker, std::vector<std::string_view>(markers.begin(), markers.end())));
        }
    }
    return wrong.empty()
               ? Status(Done{})
               : fail("{}: found no markers {} in the recording", file, join_text(wrong, ", "));
}

Result<FaceMarkers> place_markers(
    const GltfScene& face, std::span<const std::string> markers,
    std::span<const FaceMarkerPlace> map, const std::string& file) {
    const MeshData* skin = find_face_skin(face.meshes);
    if (skin == nullptr) {
        return fail("{}: found no mesh with shapes", face.name);
    }
    LIMN_TRY(check_marker_map(markers, map, file));
    std::string wrong;
    const auto add_wrong = [&](const std::string& what) {
        wrong += (wrong.empty() ? "" : ", ") + what;
    };
    std::vector<SkinPoint> places;
    for (const std::string& marker : markers) {
        const auto line = std::ranges::find(map, marker, &FaceMarkerPlace::marker);
        const bool is_mapped = line != map.end();
        if (is_mapped && line->place.empty()) {
            places.push_back(nearest_on_mesh(*skin, line->point));
            continue;
        }
        const std::string name = is_mapped ? line->place : marker;
        const std::optional<Vec2> chart = chart_of(name);
        const std::optional<std::uint32_t> vertex = chart ? vertex_at(*skin, *chart) : std::nullopt;
        if (vertex) {
            places.push_back({{*vertex, *vertex, *vertex}, {1, 0, 0}});
        } else {
            add_wrong(
                chart ? in_quotes(name) + " (beyond the texture of the face)" : nearest_name(name));
        }
    }
    if (!wrong.empty()) {
        return fail(
            "{}: found no place on the face for {}; expected \"marker = x y z\" or \"marker = "
            "place\" of them in a --map",
            file.empty() ? face.name : file, wrong);
    }
    FaceMarkers result;
    for (const SkinPoint& place : places) {
        result.points.push_back(position_on(place, skin->positions));
    }
    for (const MorphTarget& morph : skin->morphs) {
        std::vector<Vec3>& moves = result.moves.emplace_back(places.size(), Vec3(0));
        result.shapes.push_back(morph.name);
        if (!morph.drivers.empty() || morph.name.starts_with("viseme")) {
            continue;  // its weight follows those of others, or it repeats what units show
        }
        std::vector<Vec3> offsets(skin->positions.size(), Vec3(0));
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            offsets[morph.vertices[i]] = morph.positions[i];
        }
        for (std::size_t m = 0; m < places.size(); ++m) {
            moves[m] = position_on(places[m], offsets);
        }
    }
    result.costs = cost_of_weights(result.moves);
    return result;
}

MarkerMotion
retarget_markers(const MarkerMotion& motion, std::span<const Vec3> points, float gain) {
    LIMN_CHECK(points.size() == motion.markers() && motion.frames() > 0);
    const std::size_t count = motion.markers();
    const std::span<const Vec3> rest = std::span(motion.positions).first(count);
    const Result<PointWarp> warp = make_point_warp(rest, points, WarpKernel::Cubic);
    const float here = size_of(rest);
    const float scale = here > 0.0f ? size_of(points) / here : 1.0f;
    MarkerMotion moved = motion;
    for (std::size_t i = 0; i < moved.positions.size(); ++i) {
        const Vec3 from = rest[i % count];
        const Vec3 offset = motion.positions[i] - from;
        moved.positions[i] =
            points[i % count]
            + (warp ? warp_offset(*warp, from, offset, gain) : gain * scale * offset);
    }
    return moved;
}

void fit_shape_weights(
    const FaceMarkers& face, std::span<const Vec3> offsets, std::span<float> weights) {
    LIMN_CHECK(weights.size() == face.shapes.size() && offsets.size() == face.points.size());
    std::ranges::fill(weights, 0.0f);
    std::vector<Vec3> left(offsets.begin(), offsets.end());  // what is still to be explained
    const std::vector<float> squares = squares_of(face.moves);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        float largest = 0.0f;
        for (std::size_t s = 0; s < face.shapes.size(); ++s) {
            if (!(squares[s] > 0.0f)) {
                weights[s] = 0.0f;
                continue;
            }
            float along = -face.costs[s] * weights[s];
            for (std::size_t m = 0; m < left.size(); ++m) {
                along += glm::dot(face.moves[s][m], left[m]);
            }
            const float next =
                std::clamp(weights[s] + along / (squares[s] + face.costs[s]), 0.0f, 1.0f);
            const float change = next - weights[s];
            for (std::size_t m = 0; m < left.size(); ++m) {
                left[m] -= change * face.moves[s][m];
            }
            weights[s] = next;
            largest = std::max(largest, std::abs(change));
        }
        if (largest < kSettled) {
            break;
        }
    }
}

std::vector<std::vector<float>> drive_shapes(const FaceMarkers& face, const MarkerMotion& motion) {
    std::vector<std::vector<float>> rows;
    std::vector<float> weights(face.shapes.size(), 0.0f);
    std::vector<Vec3> offsets(face.points.size());
    for (std::size_t f = 0; f < motion.frames(); ++f) {
        for (std::size_t m = 0; m < offsets.size(); ++m) {
            offsets[m] = motion.positions[f * motion.markers() + m] - face.points[m];
        }
        fit_shape_weights(face, offsets, weights);
        rows.push_back(weights);
    }
    return rows;
}

}  // namespace limn
