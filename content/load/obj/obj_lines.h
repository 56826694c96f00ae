#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// The lines of OBJ files and of their material libraries, with their numbers and words. A UTF-8
// byte order mark is skipped; lines end with LF, CR LF or, in a file without LF, CR. A backslash at
// the end of a line joins the next, but not in a comment.

class ObjLines {
  public:
    /// `text` and `file` outlive it.
    ObjLines(std::string_view text, const std::string& file);

    /// False at the end of the text.
    bool next();

    /// The next word of the line, or "" at its end or at a comment: a `#`, but for the one of
    /// "-1.#IND", as Windows writes NaN.
    std::string_view word();

    /// The next word as a number: finite, and small enough for cross products of edges.
    Result<double> number(std::string_view what);

    /// The next word, which stays.
    [[nodiscard]] std::string_view peek() const;

    /// Whether the next word is a number.
    [[nodiscard]] bool is_number_next() const;

    /// All that is left of the line, without spaces around: names contain spaces and `#`.
    std::string_view rest();

    /// Whether words are left.
    [[nodiscard]] bool has_word() const;

    [[nodiscard]] std::size_t line() const { return number_; }

    /// "a.obj:7".
    [[nodiscard]] std::string position() const;

  private:
    std::string_view take_line();

    std::string_view text_;
    const std::string& file_;
    char end_of_line_;
    std::size_t at_ = 0;
    std::size_t next_number_ = 1;
    std::size_t number_ = 0;
    std::string joined_;  ///< of several lines; `rest_` may refer to it
    std::string_view rest_;
};

/// `"word"`, or `nothing`.
[[nodiscard]] std::string found_word(std::string_view word);

/// Fails for a text in UTF-16.
[[nodiscard]] Status check_encoding(std::string_view text, const std::string& file);

/// Messages on one file: a hundred, and how many more.
class ObjWarnings {
  public:
    explicit ObjWarnings(std::vector<std::string>& lines) : lines_(lines) {}
    void add(std::string line);
    /// Adds the line that counts those that were dropped.
    void finish(const std::string& file);

  private:
    static constexpr std::size_t kMaxLines = 100;
    std::vector<std::string>& lines_;
    std::size_t dropped_ = 0;
};

}  // namespace limn
