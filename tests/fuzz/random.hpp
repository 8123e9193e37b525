// Random numbers that are the same with every standard library.
#pragma once
#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace wadi::fuzz {

class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next() { // splitmix64 (Steele, Lea, Flood 2014)
        std::uint64_t x = state_ += 0x9e3779b97f4a7c15ull;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
        return x ^ (x >> 31);
    }
    double real(double low, double high) { return low + (high - low) * static_cast<double>(next() >> 11) / 9007199254740992.0; }
    /// Evenly on a logarithmic scale.
    double log(double low, double high) { return low * std::pow(high / low, real(0, 1)); }
    int whole(int low, int high) { return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1)); }
    bool chance(double share) { return real(0, 1) < share; }
    template <class T> T pick(std::initializer_list<T> of) { return of.begin()[next() % of.size()]; }

  private:
    std::uint64_t state_;
};

} // namespace wadi::fuzz
