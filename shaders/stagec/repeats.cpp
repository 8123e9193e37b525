#include "repeats.hpp"
#include "axis_block.hpp"
#include <algorithm>
#include <optional>

namespace stagec {
namespace {

// Functions with REF parameters: their names and which parameters those are.
ChangingFunctions functions_that_change(const std::string& text) {
    ChangingFunctions found;
    const Source source{"", text};
    for_each_word(text, [&](const std::string& word, std::size_t at) {
        if (word != "FN" && word != "HELPER") return;
        at = skip_blanks(text, at + word.size());
        at = skip_blanks(text, at + word_at(text, at).size()); // behind the type
        const std::string name = word_at(text, at);
        const auto parameters = arguments(source, at + name.size());
        for (std::size_t n = 0; n < parameters.size(); ++n)
            if (parameters[n].starts_with("REF(")) found[name].insert(n);
    });
    return found;
}

// A stage or part of one in which every EACH_OF function is written for each of its words.
Source words_written_out(const Source& stage) {
    Source out{stage.path, {}};
    for (std::size_t at = 0; at < stage.text.size();) {
        const std::string word = word_at(stage.text, at);
        if (word != "EACH_OF") {
            const std::size_t step = word.empty() ? 1 : word.size();
            out.text += stage.text.substr(at, step);
            at += step;
            continue;
        }
        const auto words = arguments(stage, at + word.size());
        if (words.size() != 2) stage.fail(at, "EACH_OF takes (name, other name)");
        const std::size_t begin = behind_bracket(stage, skip_blanks(stage.text, at + word.size()));
        const std::string next = word_at(stage.text, skip_blanks(stage.text, begin));
        if (next != "HELPER" && next != "EACH_AXIS") stage.fail(at, "EACH_OF stands before a HELPER");
        const std::size_t body = stage.text.find('{', begin);
        if (body == std::string::npos) stage.fail(at, "EACH_OF stands before a HELPER");
        const std::size_t end = behind_bracket(stage, body);
        const std::string text = stage.text.substr(begin, end - begin);
        const std::string other = renamed(text, {{words[0], words[1]}});
        if (other == text) stage.fail(at, "nothing in this function is named for " + words[0]);
        out.text += text + stage.goes_on_at(begin) + other;
        at = end;
    }
    return out;
}

// What the parts of a vector in a parameter block mean has nothing to do with axes: there .x would silently become .y.
void refuse_parts_of_parameters(const Source& stage, std::size_t begin, std::size_t end) {
    const std::string& text = stage.text;
    for_each_word(text.substr(0, end), [&](const std::string& word, std::size_t at) {
        if (at < begin || (word != "P" && word != "S") || text[at - 1] == '.') return;
        int members = 0;
        for (std::size_t next = at + word.size(); next < end && (text[next] == '.' || text[next] == '[');) {
            if (text[next] == '[') {
                next = behind_bracket(stage, next);
                continue;
            }
            const std::string member = word_at(text, next + 1);
            next += 1 + member.size();
            const bool part = ++members > 1 && (member == "x" || member == "y");
            if (part)
                stage.fail(at, text.substr(at, next - at) +
                                   " would be another number for the other axis: read it ahead of EACH_AXIS");
        }
    });
}

} // namespace

Source written_out(const Source& given, const std::string& reads) {
    const Source stage = words_written_out(given);
    const auto changing = functions_that_change(reads + stage.text);
    struct Found {
        std::size_t begin, end; // of the whole construct
        std::optional<AxisBlock> block;
        std::string text;
    };
    std::vector<Found> all;
    for_each_word(stage.text, [&](const std::string& word, std::size_t at) {
        if (word != "EACH_AXIS") return;
        const std::size_t next = skip_blanks(stage.text, at + word.size());
        if (next < stage.text.size() && stage.text[next] == '{') {
            const std::size_t end = behind_bracket(stage, next);
            refuse_parts_of_parameters(stage, next, end);
            all.push_back({at, end, AxisBlock(stage, next + 1, end - 1, changing), {}});
        } else if (word_at(stage.text, next) == "HELPER") {
            const std::size_t end = behind_bracket(stage, std::min(stage.text.find('{', next), stage.text.size() - 1));
            refuse_parts_of_parameters(stage, next, end);
            const std::string text = stage.text.substr(next, end - next);
            const std::string other = other_axis(text);
            if (tidy(other) == tidy(text)) stage.fail(at, "nothing in this function is another for each axis");
            all.push_back({at, end, {}, text + stage.goes_on_at(next) + other});
        } else {
            stage.fail(at, "EACH_AXIS stands before a block or a HELPER");
        }
    });
    Words locals, declared;
    for (const auto& found : all)
        if (found.block) declared.insert(found.block->declared().begin(), found.block->declared().end());
    for_each_word(stage.text, [&](const std::string& word, std::size_t) { // named for an axis outside the block
        for (const auto& name : declared)
            if (word == name + "_x" || word == name + "_y") locals.insert(name);
    });
    for (bool more = true; more;) {
        more = false;
        for (const auto& found : all)
            if (found.block) more |= found.block->find_locals(declared, locals);
    }
    for_each_word(stage.text, [&](const std::string& word, std::size_t at) {
        for (const char* suffix : {"_x", "_y"})
            for (const char* binding : {"IN", "OUT", "INOUT", "IN_IF", "OUT_IF", "INOUT_IF"})
                if (word == binding)
                    for (const auto& local : locals)
                        if (arguments(stage, at + word.size()).back() == local + suffix)
                            stage.fail(at, local + " of EACH_AXIS would be named as this binding");
    });
    Source out{stage.path, {}};
    std::size_t at = 0;
    for (const auto& found : all) {
        out.text += stage.text.substr(at, found.begin - at) + (found.block ? found.block->text(locals) : found.text);
        at = found.end;
    }
    out.text += stage.text.substr(at);
    return out;
}

} // namespace stagec
