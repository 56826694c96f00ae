#include "content/load/obj/obj_file.h"

#include "content/load/files/atomic_file.h"
#include "content/load/obj/obj_colors.h"
#include "content/load/obj/obj_lines.h"
#include "content/load/obj/triangulate_polygon.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <exception>
#include <unordered_map>
#include <utility>

namespace limn {

namespace {

/// Index of a name in a list of unique names, which grows.
class ObjNameList {
  public:
    explicit ObjNameList(std::vector<std::string>& names) : names_(names) {}

    std::uint32_t index_of(std::string_view name) {
        const auto next = static_cast<std::uint32_t>(names_.size());
        const auto [entry, is_new] = numbers_.try_emplace(std::string(name), next);
        if (is_new) {
            names_.emplace_back(name);
        }
        return entry->second;
    }
    [[nodiscard]] std::size_t size() const { return names_.size(); }

  private:
    std::vector<std::string>& names_;
    std::unordered_map<std::string, std::uint32_t> numbers_;
};

constexpr double kFarFromOrigin = 10'000;  // [file's unit], where floats have steps of 1 mm

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::string& file, const ObjLimits& limits)
        : line_(text, file), file_(file), limits_(limits) {}

    Result<ObjFile> read() {
        while (line_.next()) {
            LIMN_TRY(read_statement(line_.word()));
        }
        resolve_faces();
        resolve_strokes(result_.points, 1);
        resolve_strokes(result_.lines, 2);
        result_.colors = colors_.decode(result_.positions.size());
        errors_.finish(file_);
        return std::move(result_);
    }

  private:
    Status read_statement(std::string_view keyword) {
        if (keyword.empty() || keyword == "s") {
            return Done{};
        }
        if (keyword == "v") {
            return read_position();
        }
        if (keyword == "vt") {
            return read_uv();
        }
        if (keyword == "vn") {
            return read_normal();
        }
        if (keyword == "f" || keyword == "fo") {
            return read_face();
        }
        if (keyword == "l" || keyword == "p") {
            return read_strokes(keyword == "l");
        }
        if (keyword == "o") {
            return read_name(objects_, state_.object);
        }
        if (keyword == "g") {
            return read_name(groups_, state_.group);
        }
        if (keyword == "usemtl") {
            return read_name(materials_, state_.material);
        }
        if (keyword == "mtllib") {
            if (result_.libraries.size() < limits_.max_names) {
                result_.libraries.emplace_back(line_.rest());
            }
            return Done{};
        }
        ignore(keyword);
        return Done{};
    }

    /// One warning for each keyword, a handful at most.
    void ignore(std::string_view keyword) {
        constexpr std::size_t kMaxIgnored = 8;
        if (ignored_.size() < kMaxIgnored
            && std::find(ignored_.begin(), ignored_.end(), keyword) == ignored_.end()) {
            ignored_.emplace_back(keyword);
            result_.warnings.push_back(
                format_text("{}: {} is ignored", line_.position(), found_word(keyword)));
        }
    }

    void leave_out(std::string_view message, std::string_view what) {
        errors_.add(format_text("{}; {} is left out", message, what));
    }

    Status check_room(std::size_t size, std::size_t limit, std::string_view what) const {
        if (size < limit) {
            return Done{};
        }
        return fail("{}: found more {}, expected at most {}", line_.position(), what, limit);
    }

    Result<glm::dvec3> three_numbers(std::string_view what) {
        glm::dvec3 value;
        for (int i = 0; i < 3; ++i) {
            value[i] = LIMN_TRY(line_.number(what));
        }
        return value;
    }

    /// A bad vertex keeps its index, so that those after it keep theirs.
    Status read_position() {
        const std::size_t index = result_.positions.size();
        LIMN_TRY(check_room(index, limits_.max_vertices, "v"));
        const Result<glm::dvec3> position = three_numbers("v");
        if (position && !has_origin_) {
            has_origin_ = true;
            const bool is_far = glm::length(*position) > kFarFromOrigin;
            result_.origin = is_far ? Vec3(*position) : Vec3(0);
        }
        result_.positions.push_back(
            position ? Vec3(*position - glm::dvec3(result_.origin)) : Vec3(0));
        if (position) {
            read_color(index);
        } else {
            bad_positions_.push_back(static_cast<std::uint32_t>(index));
            leave_out(position.error().message, format_text("vertex {}", index + 1));
        }
        return Done{};
    }

    void read_color(std::size_t vertex) {
        std::array<float, 5> numbers;
        std::size_t count = 0;
        while (count < numbers.size() && line_.has_word()) {
            const Result<double> number = line_.number("v");
            if (!number) {
                leave_out(
                    number.error().message, format_text("the color of vertex {}", vertex + 1));
                return;
            }
            numbers[count++] = static_cast<float>(*number);
        }
        colors_.add(vertex, std::span(numbers).first(count));
    }

    /// The second number may be missing.
    Status read_uv() {
        LIMN_TRY(check_room(result_.uvs.size(), limits_.max_vertices, "vt"));
        Vec2 uv(0);
        for (int i = 0; i < 2 && (i == 0 || line_.has_word()); ++i) {
            const Result<double> number = line_.number("vt");
            if (!number) {
                uv = Vec2(0);
                leave_out(
                    number.error().message,
                    format_text("texture coordinate {}", result_.uvs.size() + 1));
                break;
            }
            uv[i] = static_cast<float>(*number);
        }
        result_.uvs.push_back(uv);
        return Done{};
    }

    Status read_normal() {
        LIMN_TRY(check_room(result_.normals.size(), limits_.max_vertices, "vn"));
        const Result<glm::dvec3> normal = three_numbers("vn");
        if (!normal) {
            leave_out(normal.error().message, format_text("normal {}", result_.normals.size() + 1));
        }
        result_.normals.push_back(normal ? Vec3(*normal) : Vec3(0));
        return Done{};
    }

    Status read_name(ObjNameList& names, std::uint32_t& current) {
        LIMN_TRY(check_room(names.size(), limits_.max_names, "names"));
        const std::string_view name = line_.rest();
        current = name.empty() ? 0 : names.index_of(name);
        return Done{};
    }

    Status read_face() {
        ObjFace face = state_;
        face.first = static_cast<std::uint32_t>(result_.corners.size());
        Status status = Done{};
        for (std::string_view word = line_.word(); status && !word.empty(); word = line_.word()) {
            LIMN_TRY(check_room(result_.corners.size(), limits_.max_corners, "corners of faces"));
            const Result<ObjCorner> corner = corner_of(word);
            if (corner) {
                result_.corners.push_back(*corner);
            } else {
                status = corner.error();
            }
        }
        face.count = static_cast<std::uint32_t>(result_.corners.size()) - face.first;
        if (status && face.count < 3) {
            status =
                fail("{}: found {} corners, expected at least 3", line_.position(), face.count);
        }
        if (!status) {
            result_.corners.resize(face.first);
            leave_out(status.error().message, "the face");
            return Done{};
        }
        if (face.count > kMaxEarCorners) {
            result_.warnings.push_back(format_text(
                "{}: found a polygon of {} corners, expected at most {}; it is drawn as if convex",
                line_.position(), face.count, kMaxEarCorners));
        }
        result_.faces.push_back(face);
        face_lines_.push_back(static_cast<std::uint32_t>(line_.line()));
        return Done{};
    }

    Status read_strokes(bool are_lines) {
        ObjStrokes& strokes = are_lines ? result_.lines : result_.points;
        std::vector<std::uint32_t> found;
        for (std::string_view word = line_.word(); !word.empty(); word = line_.word()) {
            LIMN_TRY(check_room(
                strokes.indices.size() + 2 * found.size(), limits_.max_corners,
                "corners of lines"));
            const Result<ObjCorner> corner = corner_of(word);
            if (!corner) {
                leave_out(corner.error().message, are_lines ? "the line" : "the point");
                return Done{};
            }
            found.push_back(corner->position);
        }
        if (found.size() < (are_lines ? 2u : 1u)) {
            leave_out(
                format_text(
                    "{}: found {} corners, expected at least {}", line_.position(), found.size(),
                    are_lines ? 2 : 1),
                are_lines ? "the line" : "the point");
            return Done{};
        }
        if (strokes.indices.empty()) {
            strokes.material = state_.material;
        }
        for (std::size_t i = 0; i + (are_lines ? 1 : 0) < found.size(); ++i) {
            strokes.indices.push_back(found[i]);
            if (are_lines) {
                strokes.indices.push_back(found[i + 1]);
            }
        }
        return Done{};
    }

    /// "7", "7/8", "7/8/9" or "7//9". Those beyond their lists are found at the end.
    Result<ObjCorner> corner_of(std::string_view word) const {
        ObjCorner corner;
        const std::string_view whole = word;
        const auto part = [&word] {
            const std::size_t end = std::min(word.find('/'), word.size());
            const std::string_view taken = word.substr(0, end);
            word.remove_prefix(std::min(end + 1, word.size()));
            return taken;
        };
        const std::string_view position = part();
        const std::string_view uv = part();
        const std::string_view normal = part();
        if (!word.empty()) {
            return fail(
                "{}: found {}, expected at most three indices", line_.position(),
                found_word(whole));
        }
        corner.position =
            static_cast<std::uint32_t>(LIMN_TRY(index_of(position, result_.positions.size(), "v")));
        if (!uv.empty()) {
            corner.uv = LIMN_TRY(index_of(uv, result_.uvs.size(), "vt"));
        }
        if (!normal.empty()) {
            corner.normal = LIMN_TRY(index_of(normal, result_.normals.size(), "vn"));
        }
        return corner;
    }

    /// From 1, or from -1 backwards. A bad one is kMaxIndex, which no list has, unless it is of a
    /// position.
    Result<std::int32_t>
    index_of(std::string_view word, std::size_t size, std::string_view keyword) const {
        std::int64_t index = 0;
        const char* const end = word.data() + word.size();
        const auto [stop, code] = std::from_chars(word.data(), end, index);
        const auto count = static_cast<std::int64_t>(size);
        const bool is_good = stop == end && code == std::errc{} && index != 0 && index >= -count
                             && index <= kMaxIndex;
        if (is_good) {
            return static_cast<std::int32_t>(index > 0 ? index - 1 : count + index);
        }
        if (keyword != "v" && stop == end) {
            return kMaxIndex;
        }
        return fail(
            "{}: found {}, expected an index of {}, from 1 or from -1 back to -{}",
            line_.position(), found_word(word), keyword, count);
    }

    /// Checks all indices, now that the lists are complete.
    void resolve_faces() {
        normal_count_ = std::ssize(result_.normals);
        std::size_t kept = 0;
        for (std::size_t f = 0; f < result_.faces.size(); ++f) {
            const ObjFace& face = result_.faces[f];
            if (check_positions(face, face_lines_[f])) {
                check_attributes(face, face_lines_[f]);
                result_.faces[kept++] = face;
            }
        }
        result_.faces.resize(kept);
    }

    /// Drops those, of `size` indices each, that have a bad one.
    void resolve_strokes(ObjStrokes& strokes, std::size_t size) {
        std::vector<std::uint32_t>& indices = strokes.indices;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < indices.size(); i += size) {
            if (is_position(indices[i]) && is_position(indices[i + size - 1])) {
                indices[kept] = indices[i];
                indices[kept + size - 1] = indices[i + size - 1];
                kept += size;
            }
        }
        if (kept < indices.size()) {
            errors_.add(format_text(
                "{}: found {} {} with an index that is not of the {} vertices; they are left out",
                file_, (indices.size() - kept) / size, size == 2 ? "lines" : "points",
                result_.positions.size()));
        }
        indices.resize(kept);
    }

    [[nodiscard]] bool is_position(std::uint32_t index) const {
        return index < result_.positions.size()
               && !std::binary_search(bad_positions_.begin(), bad_positions_.end(), index);
    }

    bool check_positions(const ObjFace& face, std::uint32_t line) {
        for (const ObjCorner& corner : corners_of(face)) {
            const std::uint32_t index = corner.position;
            if (index >= result_.positions.size()) {
                errors_.add(format_text(
                    "{}:{}: found {}, expected an index into the {} vertices; the face is left out",
                    file_, line, index + std::uint64_t{1}, result_.positions.size()));
                return false;
            }
            if (std::binary_search(bad_positions_.begin(), bad_positions_.end(), index)) {
                errors_.add(format_text(
                    "{}:{}: found vertex {}, which is left out, expected one of finite numbers; "
                    "the face is left out",
                    file_, line, index + 1));
                return false;
            }
        }
        return true;
    }

    void check_attributes(const ObjFace& face, std::uint32_t line) {
        const std::span<ObjCorner> corners = corners_of(face);
        const auto drop = [&](auto is_bad, std::int64_t count, std::string_view what) {
            const bool found = std::any_of(corners.begin(), corners.end(), is_bad);
            if (found) {
                errors_.add(format_text(
                    "{}:{}: found an index beyond the {} {}, expected one of them; the face has no "
                    "{}",
                    file_, line, count, what, what));
            }
            return found;
        };
        const std::int64_t uvs = std::ssize(result_.uvs);
        if (drop([&](const ObjCorner& c) { return c.uv >= uvs; }, uvs, "texture coordinates")) {
            for (ObjCorner& corner : corners) {
                corner.uv = -1;
            }
        }
        const auto is_bad = [&](const ObjCorner& c) { return c.normal >= normal_count_; };
        if (drop(is_bad, normal_count_, "normals")) {
            for (ObjCorner& corner : corners) {
                corner.normal = no_normal();
            }
        }
    }

    /// A normal to be made anew, while those of other faces stay.
    std::int32_t no_normal() {
        if (std::ssize(result_.normals) == normal_count_) {
            result_.normals.emplace_back(0);
        }
        return static_cast<std::int32_t>(normal_count_);
    }

    std::span<ObjCorner> corners_of(const ObjFace& face) {
        return std::span(result_.corners).subspan(face.first, face.count);
    }

    static constexpr std::int32_t kMaxIndex = 0x7fffffff;

    ObjLines line_;
    const std::string& file_;
    const ObjLimits& limits_;
    ObjFile result_;
    ObjFace state_;  ///< object, group and material of the next face
    ObjNameList objects_{result_.objects};
    ObjNameList groups_{result_.groups};
    ObjNameList materials_{result_.materials};
    ObjColors colors_;
    ObjWarnings errors_{result_.errors};
    bool has_origin_ = false;
    std::vector<std::string> ignored_;
    std::vector<std::uint32_t> face_lines_;     ///< line of each face
    std::vector<std::uint32_t> bad_positions_;  ///< sorted
    std::int64_t normal_count_ = 0;             ///< of the file
};

}  // namespace

Result<ObjFile> parse_obj(std::string_view text, const std::string& file, const ObjLimits& limits) {
    LIMN_TRY(check_encoding(text, file));
    try {
        return ObjReader(text, file, limits).read();
    } catch (const std::exception& exception) {  // out of memory
        return fail("{}: cannot be loaded: {}", file, exception.what());
    }
}

Result<ObjFile> load_obj(const std::string& path, const ObjLimits& limits) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path, limits.max_bytes));
    return parse_obj({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, limits);
}

Result<ObjFile> load_intact_obj(const std::string& path) {
    ObjFile obj = LIMN_TRY(load_obj(path));
    if (!obj.errors.empty()) {
        return Error{obj.errors.front()};
    }
    if (obj.origin != Vec3(0)) {
        return fail(
            "{}: found its first vertex far from the origin, expected it within {}", path,
            kFarFromOrigin);
    }
    return obj;
}

}  // namespace limn
