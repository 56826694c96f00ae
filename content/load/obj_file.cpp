#include "content/load/obj_file.h"

#include "content/load/atomic_file.h"
#include "content/load/json_document.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <unordered_map>
#include <utility>

namespace limn {

namespace {

/// [file's unit]; beyond it cross products of edges overflow a float.
constexpr double kLargestNumber = 1e9;
constexpr std::size_t kMaxEarCorners = 64;

constexpr std::string_view kSpaces = " \t\r\v\f";

/// Lines of a text with their numbers and words. A backslash at the end of a line joins the next.
class LineReader {
  public:
    explicit LineReader(std::string_view text) : text_(text) {}

    /// False at the end of the text.
    bool next() {
        if (at_ >= text_.size()) {
            return false;
        }
        joined_.clear();
        number_ = next_number_;
        rest_ = take_line();
        while (rest_.ends_with('\\') && at_ < text_.size()) {
            if (joined_.empty()) {
                joined_ = rest_;
            }
            joined_.back() = ' ';
            joined_ += take_line();
            rest_ = joined_;
        }
        rest_ = rest_.substr(0, rest_.find('#'));
        return true;
    }

    /// The next word of the line, or "".
    std::string_view word() {
        skip_spaces();
        const std::string_view found = rest_.substr(0, rest_.find_first_of(kSpaces));
        rest_.remove_prefix(found.size());
        return found;
    }

    /// All that is left of the line, without spaces around.
    std::string_view rest() {
        skip_spaces();
        const std::size_t last = rest_.find_last_not_of(kSpaces);
        return rest_.substr(0, last == std::string_view::npos ? 0 : last + 1);
    }

    [[nodiscard]] std::size_t number() const { return number_; }

  private:
    void skip_spaces() {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kSpaces), rest_.size()));
    }

    std::string_view take_line() {
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        std::string_view line = text_.substr(at_, end - at_);
        if (line.ends_with('\r')) {
            line.remove_suffix(1);
        }
        at_ = end + 1;
        ++next_number_;
        return line;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t next_number_ = 1;
    std::size_t number_ = 0;
    std::string joined_;  ///< of several lines; `rest_` may refer to it
    std::string_view rest_;
};

/// What the readers of both formats share.
class Reader {
  protected:
    Reader(std::string_view text, const std::string& file, const ObjLimits& limits)
        : line_(text), file_(file), limits_(limits) {}

    [[nodiscard]] std::string place() const { return format_text("{}:{}", file_, line_.number()); }

    Result<float> number(std::string_view what) {
        const std::string_view word = line_.word();
        double value = 0;
        const char* const begin = word.data() + (word.starts_with('+') ? 1 : 0);
        const char* const end = word.data() + word.size();
        const auto [stop, code] = std::from_chars(begin, end, value);
        if (word.empty() || stop != end || code != std::errc{}
            || !(std::abs(value) <= kLargestNumber)) {
            return fail(
                "{}: {}: found {}, expected a number of at most {}", place(), what, found(word),
                kLargestNumber);
        }
        return static_cast<float>(value);
    }

    static std::string found(std::string_view word) {
        return word.empty() ? "nothing" : in_quotes(word);
    }

    LineReader line_;
    const std::string& file_;
    const ObjLimits& limits_;
};

/// Index of a name in a list of unique names, which grows.
class NameList {
  public:
    explicit NameList(std::vector<std::string>& names) : names_(names) {}

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

class ObjReader : Reader {
  public:
    ObjReader(std::string_view text, const std::string& file, const ObjLimits& limits)
        : Reader(text, file, limits) {}

    Result<ObjFile> read() {
        while (line_.next()) {
            LIMN_TRY(read_statement(line_.word()));
        }
        return std::move(result_);
    }

  private:
    Status read_statement(std::string_view keyword) {
        if (keyword.empty() || keyword == "s") {
            return Done{};
        }
        if (keyword == "v") {
            return read_vector(result_.positions, "v");
        }
        if (keyword == "vt") {
            return read_uv();
        }
        if (keyword == "vn") {
            return read_vector(result_.normals, "vn");
        }
        if (keyword == "f" || keyword == "fo") {
            return read_face();
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
                format_text("{}: {} is ignored", place(), in_quotes(keyword)));
        }
    }

    Status check_room(std::size_t size, std::size_t limit, std::string_view what) const {
        if (size < limit) {
            return Done{};
        }
        return fail("{}: found more {}, expected at most {}", place(), what, limit);
    }

    /// Three numbers; more, as a weight or a color, are ignored.
    Status read_vector(std::vector<Vec3>& list, std::string_view keyword) {
        LIMN_TRY(check_room(list.size(), limits_.max_vertices, keyword));
        Vec3 value;
        for (int i = 0; i < 3; ++i) {
            value[i] = LIMN_TRY(number(keyword));
        }
        list.push_back(value);
        return Done{};
    }

    /// The second number may be missing.
    Status read_uv() {
        LIMN_TRY(check_room(result_.uvs.size(), limits_.max_vertices, "vt"));
        Vec2 uv = {LIMN_TRY(number("vt")), 0};
        if (!line_.rest().empty()) {
            uv.y = LIMN_TRY(number("vt"));
        }
        result_.uvs.push_back(uv);
        return Done{};
    }

    Status read_name(NameList& names, std::uint32_t& current) {
        LIMN_TRY(check_room(names.size(), limits_.max_names, "names"));
        const std::string_view name = line_.rest();
        current = name.empty() ? 0 : names.index_of(name);
        return Done{};
    }

    Status read_face() {
        ObjFace face = state_;
        face.first = static_cast<std::uint32_t>(result_.corners.size());
        for (std::string_view word = line_.word(); !word.empty(); word = line_.word()) {
            LIMN_TRY(check_room(result_.corners.size(), limits_.max_corners, "corners of faces"));
            result_.corners.push_back(LIMN_TRY(corner_of(word)));
        }
        face.count = static_cast<std::uint32_t>(result_.corners.size()) - face.first;
        if (face.count < 3) {
            return fail("{}: found {} corners, expected at least 3", place(), face.count);
        }
        result_.faces.push_back(face);
        return Done{};
    }

    /// "7", "7/8", "7/8/9" or "7//9".
    Result<ObjCorner> corner_of(std::string_view word) {
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
            return fail("{}: found {}, expected at most three indices", place(), in_quotes(whole));
        }
        corner.position = LIMN_TRY(index_of(position, result_.positions.size(), "vertices"));
        if (!uv.empty()) {
            corner.uv = static_cast<std::int32_t>(
                LIMN_TRY(index_of(uv, result_.uvs.size(), "texture coordinates")));
        }
        if (!normal.empty()) {
            corner.normal = static_cast<std::int32_t>(
                LIMN_TRY(index_of(normal, result_.normals.size(), "normals")));
        }
        return corner;
    }

    /// From 1, or from -1 backwards; the list must have it already.
    Result<std::uint32_t>
    index_of(std::string_view word, std::size_t size, std::string_view what) const {
        std::int64_t index = 0;
        const char* const end = word.data() + word.size();
        const auto [stop, code] = std::from_chars(word.data(), end, index);
        const auto count = static_cast<std::int64_t>(size);
        if (stop != end || code != std::errc{} || index == 0 || index > count || index < -count) {
            return fail(
                "{}: found {}, expected an index into the {} {} so far", place(), found(word), size,
                what);
        }
        return static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
    }

    ObjFile result_;
    ObjFace state_;  ///< object, group and material of the next face
    NameList objects_{result_.objects};
    NameList groups_{result_.groups};
    NameList materials_{result_.materials};
    std::vector<std::string> ignored_;
};

class MaterialReader : Reader {
  public:
    MaterialReader(std::string_view text, const std::string& file, const ObjLimits& limits)
        : Reader(text, file, limits) {}

    Result<std::vector<ObjMaterial>> read() {
        while (line_.next()) {
            const std::string_view keyword = line_.word();
            if (keyword == "newmtl") {
                if (result_.size() >= limits_.max_names) {
                    return fail(
                        "{}: found more materials, expected at most {}", place(),
                        limits_.max_names);
                }
                result_.push_back({.name = std::string(line_.rest())});
            } else if (!result_.empty()) {
                LIMN_TRY(read_value(keyword, result_.back()));
            }
        }
        return std::move(result_);
    }

  private:
    Status read_value(std::string_view keyword, ObjMaterial& material) {
        if (keyword == "Kd") {
            return read_color(keyword, 1, material.diffuse);
        }
        if (keyword == "Ke") {
            return read_color(keyword, 1e6f, material.emission);
        }
        if (keyword == "Ns") {
            material.shininess = LIMN_TRY(in_range(keyword, 1000));
        } else if (keyword == "d") {
            material.opacity = LIMN_TRY(in_range(keyword, 1));
        } else if (keyword == "Tr") {
            material.opacity = 1 - LIMN_TRY(in_range(keyword, 1));
        }
        return Done{};
    }

    Result<float> in_range(std::string_view keyword, float max) {
        const float value = LIMN_TRY(number(keyword));
        if (value < 0 || value > max) {
            return fail("{}: {}: found {}, expected 0 to {}", place(), keyword, value, max);
        }
        return value;
    }

    /// One number is gray.
    Status read_color(std::string_view keyword, float max, Vec3& color) {
        color = Vec3(LIMN_TRY(in_range(keyword, max)));
        for (int i = 1; i < 3 && !line_.rest().empty(); ++i) {
            color[i] = LIMN_TRY(in_range(keyword, max));
        }
        return Done{};
    }

    std::vector<ObjMaterial> result_;
};

/// Cuts the corner `at` of `rest` off.
void cut_ear(
    std::vector<std::uint32_t>& rest, std::size_t at, std::vector<std::uint32_t>& triangles) {
    const std::size_t n = rest.size();
    triangles.insert(triangles.end(), {rest[(at + n - 1) % n], rest[at], rest[(at + 1) % n]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
}

class EarCutter {
  public:
    explicit EarCutter(std::span<const Vec3> corners) : p_(corners) {
        // Newell's normal: the sum of the cross products of the edges.
        for (std::size_t i = 0; i < p_.size(); ++i) {
            normal_ += glm::cross(p_[i] - p_[0], p_[(i + 1) % p_.size()] - p_[0]);
        }
    }

    /// Twice the area of a triangle in the plane of the polygon, negative if it faces back.
    [[nodiscard]] float area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return glm::dot(normal_, glm::cross(p_[b] - p_[a], p_[c] - p_[a]));
    }

    [[nodiscard]] bool is_ear(const std::vector<std::uint32_t>& rest, std::size_t at) const {
        const std::size_t n = rest.size();
        const std::uint32_t a = rest[(at + n - 1) % n];
        const std::uint32_t b = rest[at];
        const std::uint32_t c = rest[(at + 1) % n];
        if (!(area(a, b, c) > 0)) {
            return false;
        }
        return std::none_of(rest.begin(), rest.end(), [&](std::uint32_t p) {
            return p != a && p != b && p != c && area(a, b, p) >= 0 && area(b, c, p) >= 0
                   && area(c, a, p) >= 0;
        });
    }

  private:
    std::span<const Vec3> p_;
    Vec3 normal_ = Vec3(0);
};

}  // namespace

std::vector<std::uint32_t> triangulate_polygon(std::span<const Vec3> corners) {
    std::vector<std::uint32_t> triangles;
    const auto count = static_cast<std::uint32_t>(corners.size());
    const EarCutter cutter(corners);
    if (count == 4 && cutter.area(0, 1, 2) > 0 && cutter.area(0, 2, 3) > 0) {
        return {0, 1, 2, 0, 2, 3};
    }
    if (count == 4 && cutter.area(1, 2, 3) > 0 && cutter.area(1, 3, 0) > 0) {
        return {0, 1, 3, 1, 2, 3};
    }
    std::vector<std::uint32_t> rest(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        rest[i] = i;
    }
    while (rest.size() > 3 && rest.size() <= kMaxEarCorners) {
        std::size_t at = 0;
        while (at < rest.size() && !cutter.is_ear(rest, at)) {
            ++at;
        }
        if (at == rest.size()) {
            break;  // it crosses itself, or has no area
        }
        cut_ear(rest, at, triangles);
    }
    for (std::size_t i = 1; i + 1 < rest.size(); ++i) {
        triangles.insert(triangles.end(), {rest[0], rest[i], rest[i + 1]});
    }
    return triangles;
}

Result<ObjFile> parse_obj(std::string_view text, const std::string& file, const ObjLimits& limits) {
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

Result<std::vector<ObjMaterial>>
parse_obj_materials(std::string_view text, const std::string& file, const ObjLimits& limits) {
    return MaterialReader(text, file, limits).read();
}

}  // namespace limn
