// The inside of EACH_AXIS { }: which of its statements and locals are another for each axis, and the text of both.
#pragma once
#include "source.hpp"
#include <map>

namespace stagec {

using Words = std::set<std::string>;
/// Functions that change what they are given: which of their parameters.
using ChangingFunctions = std::map<std::string, std::set<std::size_t>>;

/// Names with the parts between their underscores replaced.
std::string renamed(const std::string& text, const std::map<std::string, std::string>& parts);
/// On one line with single blanks.
std::string tidy(const std::string& text);
/// Text with x and y, xx and yy, i and j, nx and ny, columns and rows exchanged in every name, and the arguments of IDX in the
/// other order.
std::string other_axis(const std::string& text);

class AxisBlock {
  public:
    /// The block between two places of a stage.
    AxisBlock(const Source& source, std::size_t begin, std::size_t end, const ChangingFunctions& changing);

    /// Adds to `locals` those of `declared` that turn out to be another for each axis; true if there were new ones.
    bool find_locals(const Words& declared, Words& locals) const;
    const Words& declared() const { return declared_; }
    /// Every statement that is another for each axis for both of them, on one line; `locals` get the axis as suffix.
    std::string text(const Words& locals) const;

  private:
    // A statement up to its semicolon, or text that stands once: braces, else, conditions.
    struct Piece {
        std::string text;
        std::size_t at = 0;
        bool statement = false;
    };
    void split(std::size_t begin, std::size_t end);
    std::size_t statement_end(std::size_t at) const;
    void note_declared(std::size_t begin, std::size_t end);
    Words changed_by(const Piece& piece, const Words& declared) const;

    const Source& source_;
    const ChangingFunctions& changing_;
    std::vector<Piece> pieces_;
    Words declared_;
};

} // namespace stagec
