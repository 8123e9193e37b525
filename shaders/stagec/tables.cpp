#include "writers.hpp"
#include <algorithm>
#include <cctype>
#include <sstream>

namespace stagec {

bool is_fused(const std::string& path) { return path.ends_with(".fused"); }

static std::string lacks_of(const Stage& s, const Effects& effects) {
    if (s.lacks.empty()) return "";
    std::ostringstream o;
    o << "constexpr StageLack lacks_" << s.name << "[] = {\n";
    for (const auto& lack : s.lacks) {
        unsigned slots = 0;
        for (const auto& b : s.bindings) {
            if (std::find(lack.fields.begin(), lack.fields.end(), b.name) != lack.fields.end()) slots |= 1u << b.slot;
        }
        o << "    {" << slots << "u, " << effect_bits(lack.less, effects, s.path) << "u},\n";
    }
    o << "};\n";
    return o.str();
}

std::string stage_table(const std::vector<std::string>& paths, const Effects& effects, const std::string& spirv_dir) {
    std::vector<FusedStage> stages; // one that is not fused has no parts
    for (const auto& path : paths) {
        if (is_fused(path)) {
            stages.push_back(parse_fused(path, effects));
        } else {
            stages.emplace_back().stage = parse_stage(path);
        }
    }
    std::ostringstream o;
    o << "// Written by stagec from the stage files.\n#include \"shaders/stage_table.hpp\"\n#include <array>\nnamespace "
         "wadi::compute {\nnamespace {\n";
    for (const auto& fused : stages) {
        const Stage& s = fused.stage;
        o << "constexpr StageBinding bindings_" << s.name << "[] = {\n";
        for (const auto& b : s.bindings) {
            const std::map<std::string, std::string> types = {{"float", "f32"}, {"uint", "u32"},  {"int", "i32"},
                                                              {"vec2", "vec2"}, {"vec4", "vec4"}, {"uvec2", "uvec2"}};
            const std::map<std::string, std::string> access = {{"IN", "in"}, {"OUT", "out"}, {"INOUT", "inout"}};
            o << "    {\"" << b.name << "\", " << b.slot << ", Access::" << access.at(b.access)
              << ", Scalar::" << types.at(b.type) << ", " << b.condition << ", " << b.empty << "},\n";
        }
        o << "};\n" << lacks_of(s, effects);
        if (spirv_dir != "-") {
            o << "constexpr std::uint32_t spirv_" << s.name << "[] = {" << word_list(spirv_dir + "/" + s.name + ".spv")
              << "\n};\n";
        }
    }
    o << "constexpr StageInfo stages[] = {\n";
    for (const auto& fused : stages) {
        const Stage& s = fused.stage;
        std::string extent = s.extent;
        for (auto& c : extent) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        o << "    {\"" << s.name << "\", Extent::" << extent << ", {" << s.reach.west << ", " << s.reach.south << ", "
          << s.reach.east << ", " << s.reach.north << "}, " << effect_bits(s.far, effects, s.path) << "u, "
          << (marks(s) ? "true" : "false") << ", " << tested_bits(s, effects) << "u, bindings_" << s.name << ", "
          << (spirv_dir != "-" ? "spirv_" + s.name : "std::span<const std::uint32_t>{}") << ", " << fused.parts.size() << ", "
          << fused.needs << "u, " << fused.without << "u, "
          << (s.lacks.empty() ? "std::span<const StageLack>{}" : "lacks_" + s.name) << "},\n";
    }
    o << "};\n} // namespace\nstd::span<const StageInfo> stage_table() {\n    return stages;\n}\n} // namespace wadi::compute\n";
    return o.str();
}

std::string cpu_rows(const std::string& isas, bool fused, const std::vector<std::string>& paths) {
    std::ostringstream o;
    std::vector<std::string> sets;
    std::istringstream list(isas);
    for (std::string isa; std::getline(list, isa, ',');) sets.push_back(isa);
    // Fused stages are slower here than their parts and compiled for the base set at most: they are there to be compared with.
    const auto function = [](const std::string& isa, const std::string& path) {
        return "wadi_cpu_" + (is_fused(path) ? std::string("base") : isa) + "_" + stem(path);
    };
    o << "// Written by stagec: which function runs a stage, by instruction set; in the order of the stage table.\n"
      << "#include \"backends/cpu/stages.hpp\"\nextern \"C\" {\n";
    for (const auto& isa : sets)
        for (const auto& path : paths)
            if (fused || !is_fused(path)) o << "wadi::cpu::StageBlock " << function(isa, path) << "(unsigned effects);\n";
    o << "}\nnamespace wadi::cpu {\nnamespace {\n";
    for (const auto& isa : sets) {
        o << "constexpr StageSelect select_" << isa << "[] = {\n";
        for (const auto& path : paths) o << "    " << (fused || !is_fused(path) ? function(isa, path) : "nullptr") << ",\n";
        o << "};\n";
    }
    o << "constexpr InstructionSet sets[] = {\n";
    for (const auto& isa : sets) o << "    {\"" << isa << "\", select_" << isa << ", " << (fused ? "true" : "false") << "},\n";
    o << "};\n} // namespace\nstd::span<const InstructionSet> instruction_sets() {\n    return sets;\n}\n} // namespace "
         "wadi::cpu\n";
    return o.str();
}

std::string cuda_rows(const std::vector<std::string>& stages) {
    std::ostringstream o;
    o << "// Written by stagec: which function selects a stage's kernel; in the order of the stage table.\n"
      << "#include \"backends/cuda/stages.hpp\"\nextern \"C\" {\n";
    for (const auto& s : stages)
        o << "const void* wadi_cuda_" << s << "(unsigned effects, int group_x, int group_y);\nconst void* wadi_cuda_active_" << s
          << "(unsigned effects);\n";
    o << "}\nnamespace wadi::cuda {\nstd::span<const KernelSelect> kernels() {\n    static constexpr KernelSelect list[] = {\n";
    for (const auto& s : stages) o << "        wadi_cuda_" << s << ",\n";
    o << "    };\n    return list;\n}\nstd::span<const ActiveKernelSelect> active_kernels() {\n    static constexpr "
         "ActiveKernelSelect list[] = {\n";
    for (const auto& s : stages) o << "        wadi_cuda_active_" << s << ",\n";
    o << "    };\n    return list;\n}\n} // namespace wadi::cuda\n";
    return o.str();
}

} // namespace stagec
