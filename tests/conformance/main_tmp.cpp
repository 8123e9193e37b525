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
        for (const Layer* l : {&contract_layer(), &stage_layer(), &step_layer(), &invariant_layer()}) {
        auto specs = l->list();
        if (c > 2 && v[2][0]) { auto p = parse_case(v[2]); std::vector<CaseSpec> k; for (auto& q : specs) if (q.name == p->name) k.push_back(q); if (!p->parameters.empty() && !k.empty()) k = {*p}; specs = k; }
        for (auto& spec : specs) {
            auto a = std::chrono::steady_clock::now();
            auto verdict = l->run(spec, s);
            r.add(t.label(), l->name, spec.text(), verdict, std::chrono::duration<double>(std::chrono::steady_clock::now() - a).count());
        }
        }
    }
    r.finish();
}
