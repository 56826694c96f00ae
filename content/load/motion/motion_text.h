#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace limn {

// Words of motion capture files, with their lines. A UTF-8 byte order mark is skipped; lines end
// with LF, CR LF or CR. Braces are words even without white space around them.

class MotionText {
  public:
    /// `text` and `file` outlive it.
    MotionText(std::string_view text, const std::string& file);

    /// The next word, "" at the end of the file. Each of `marks` is a word of its own.
    std::string_view word(std::string_view marks = "{}");
    /// The same, which stays.
    [[nodiscard]] std::string_view peek(std::string_view marks = "{}") const;

    /// The rest of the line up to the first of `stops`, without white space around it.
    std::string_view rest_of_line(std::string_view stops = "");

    /// The next line with a word in it, without white space around it; "" at the end of the file.
    std::string_view line();

    /// The next word as a number.
    Result<float> number(std::string_view what);

    /// "walk.bvh:7", of the last word or line; at the end of the file, its last line.
    [[nodiscard]] std::string position() const;
    [[nodiscard]] std::size_t line_number() const { return found_line_; }

  private:
    void skip_spaces();
    void advance(std::size_t count);

    std::string_view text_;  ///< what is left
    const std::string& file_;
    std::size_t line_ = 1;        ///< where text_ begins
    std::size_t found_line_ = 1;  ///< of the last word
    bool after_return_ = false;   ///< the last character was CR: LF ends no other line
};

/// Takes the next word between spaces and tabs from `line`; "" at its end.
[[nodiscard]] std::string_view take_word(std::string_view& line);

/// Whether `word` is a finite number of at most 1e9, independent of the locale.
[[nodiscard]] bool parse_motion_number(std::string_view word, float& number);

/// Whether the words are equal but for the case of their ASCII letters.
[[nodiscard]] bool equals_ignoring_case(std::string_view a, std::string_view b);

/// `"word"`, or "the end of the file".
[[nodiscard]] std::string found_motion_word(std::string_view word);

}  // namespace limn
