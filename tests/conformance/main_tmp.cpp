#include "tests/conformance/stage_layer.hpp"
#include "tests/conformance/report.hpp"
#include <chrono>
#include <cstring>
using namespace wadi;
using namespace wadi::conformance;
int main(int c, char** v) {
    Report r(false);
    for (auto& t : all_targets()) {
        if (c > 1 && t.info.backend != v[1]) continue;
        compute::DeviceOptions o; o.validate = c > 3;
        Session s(t, o);
        auto specs = stage_layer().list();
        if (c > 2 && v[2][0]) { auto p = parse_case(v[2]); if (p->parameters.empty()) { std::vector<CaseSpec> k; for (auto& q : specs) if (q.name == p->name) k.push_back(q); specs = k; } else specs = {*p}; }
        for (auto& spec : specs) {
            auto a = std::chrono::steady_clock::now();
            auto verdict = stage_layer().run(spec, s);
            r.add(t.label(), "stage", spec.text(), verdict, std::chrono::duration<double>(std::chrono::steady_clock::now() - a).count());
        }
    }
    r.finish();
}
