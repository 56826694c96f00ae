#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// JSON with comments (// and /* */), read into values that know where they were written, so that
// whoever finds one wrong can point at it: "levels/pool.level.json:12:20: ...".
//
// Our own parser, because the position of every value is the point of it: a library's parser counts
// lines for syntax errors only. RFC 8259 beside the comments: no trailing commas, no NaN, strings
// are valid UTF-8; keys of an object must differ. A number keeps its spelling, which says what the
// user wrote and carries 64-bit integers that a double cannot hold. Depth, size and count are
// bounded, so a hostile file ends in an error.

/// Where something stands in a text; both count from 1, the column in characters. 0 = made by code.
struct SourcePosition {
    std::uint32_t line = 0;
    std::uint32_t column = 0;
};

enum class JsonKind : std::uint8_t { Null, Bool, Number, String, Array, Object };

struct JsonMember;

struct JsonValue {
    JsonKind kind = JsonKind::Null;
    bool truth = false;               ///< of Bool
    SourcePosition at;                ///< of its first character
    double number = 0.0;              ///< of Number, finite
    std::string text;                 ///< of String: decoded UTF-8; of Number: as spelled
    std::vector<JsonValue> items;     ///< of Array
    std::vector<JsonMember> members;  ///< of Object, as written; keys differ

    /// The member's value, or null when this is no object or has no such key.
    [[nodiscard]] const JsonValue* find(std::string_view key) const;
};

struct JsonMember {
    std::string key;
    SourcePosition at;  ///< of the key
    JsonValue value;
};

/// What a text may cost.
struct JsonLimits {
    std::size_t max_bytes = std::size_t{64} << 20;
    std::size_t max_values = 4'000'000;
    int max_depth = 64;  ///< of arrays and objects in each other
};

/// Parses one value and nothing after it. `file` begins the error's line: "file:line:column: found
/// X, expected Y".
[[nodiscard]] Result<JsonValue>
parse_json(std::string_view text, std::string_view file, const JsonLimits& limits = {});

/// Fails when `path` cannot be read, is no regular file or is too large, too.
[[nodiscard]] Result<JsonValue> load_json(const std::string& path, const JsonLimits& limits = {});

/// As text that parse_json reads back to the same value; short arrays and objects on one line.
[[nodiscard]] std::string write_json(const JsonValue& value);

/// Values for write_json. A float is spelled with as few digits as give it back exactly.
[[nodiscard]] JsonValue json_of(bool truth);
[[nodiscard]] JsonValue json_of(float number);
[[nodiscard]] JsonValue json_of(double number);
[[nodiscard]] JsonValue json_of(std::int64_t number);
[[nodiscard]] JsonValue json_of(std::uint64_t number);
[[nodiscard]] JsonValue json_of(std::string_view text);
[[nodiscard]] JsonValue json_array(std::vector<JsonValue> items = {});
[[nodiscard]] JsonValue json_object(std::vector<JsonMember> members = {});

/// For the "found" of a message, on one line and never long: `the string "abc"`, `the number 7`,
/// `an object`.
[[nodiscard]] std::string describe(const JsonValue& value);

/// `text` in quotes, escaped, cut when long: what messages show of strings from a file.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// " (did you mean Z?)", or "" when nothing is near.
[[nodiscard]] std::string
did_you_mean(std::string_view name, const std::vector<std::string_view>& candidates);

}  // namespace limn
