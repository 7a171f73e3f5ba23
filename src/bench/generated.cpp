// Implements the generated scenes as YAML texts.
#include "bench/generated.hpp"
#include "reader/load_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catena::command {

Scene random_scene(std::string const& joint, std::int64_t bodies,
                   std::vector<std::string> const& overrides, std::string const& loads) {
    std::string const name = fmt::format("random-{}-{}", joint, bodies);
    std::string const text = fmt::format(
        "title: random chain, {0}, {1} bodies\n"
        "units: si\n"
        "chains: [{{name: random, base: {2}, generator: {{random: {{bodies: {1}, joint: {0}, seed: "
        "1}}}}}}]\n"
        "forces: {{gravity: [0, 0, -9.81]}}\n",
        joint, bodies, joint == "link" ? "free" : "fixed");
    Scene scene = parse_scene(text, name, overrides);
    BodyArrays& all = scene.chains.front().bodies;
    if (loads != "wrenches") all.wrench.clear();
    if (loads == "none") all.torque.clear();
    return scene;
}

void make_alike(Scene& scene) {
    auto const as_second = [](auto& values, std::ptrdiff_t first = 0) {
        if (values.size() < 2) return;
        auto const second = values[1];
        std::fill(values.begin() + first, values.end(), second);
    };
    ChainSpec& chain = scene.chains.front();
    as_second(chain.beads.mass);
    BodyArrays& b = chain.bodies;
    as_second(b.mass), as_second(b.com), as_second(b.inertia);
    as_second(b.axis), as_second(b.first_axis), as_second(b.pitch);
    as_second(b.rotation, 1), as_second(b.translation, 1);
}

Scene swinging_scene(std::string const& joint, std::vector<std::string> const& overrides) {
    std::string const text = fmt::format(
        "title: 8 swinging bodies, {0}\n"
        "units: si\n"
        "chains: [{{name: swinging, base: fixed, generator: {{random: {{bodies: 8, joint: {0}, "
        "seed: 4{1}}}}}}}]\n"
        "forces: {{gravity: [0, -3, -5]}}\n",
        joint, joint == "link" ? "" : ", loads: false");
    return parse_scene(text, "swinging-" + joint, overrides);
}

Scene elastic_scene(std::vector<std::string> const& overrides) {
    constexpr int rods = 8;
    // The slowest mode has a period of 1.6 s. A run of half a second ends after about a quarter of
    // that.
    constexpr double stiffness = 5.3;
    // Rotation rate of the last rod at the start.
    constexpr double turning = 2.0;
    // Curvature of a clamped rod that bends under the weight of its own sag. This is almost that of
    // the slowest mode. The coordinate u is 1 at the clamp and 0 at the end.
    auto const bending = [](double u) { return u * u * (1.5 - u * (2.0 / 3 - u * u * u / 30)); };
    std::string text =
        "title: clamped elastic rod, 8 rods\nunits: si\nchains:\n  - name: rod\n    base: fixed\n  "
        "  bodies:\n";
    double sum = 0;
    for (int k = 0; k < rods; ++k) sum += bending(1 - static_cast<double>(k) / rods);
    for (int k = 0; k < rods; ++k) {
        double const rate = turning * bending(1 - static_cast<double>(k) / rods) / sum;
        text += fmt::format(
            "      - {{mass: 0.1, com: [0.05, 0, 0], inertia: [5e-6, 8.6e-5, 8.6e-5], joint: "
            "{{type: spherical, translation: [{}, 0, 0], "
            "stiffness: [{}, {}, {}], qd: [0, {}, {}]}}}}\n",
            k == 0 ? 0.0 : 0.1, stiffness, stiffness, stiffness, 0.5 * rate, rate);
    }
    return parse_scene(text, "elastic", overrides);
}

Scene coil_scene(std::int64_t bodies, std::vector<std::string> const& overrides) {
    std::string const text = fmt::format(
        "title: coil, {0} bodies\n"
        "units: si\n"
        "chains: [{{name: coil, base: fixed, generator: {{coil: {{bodies: {0}}}}}}}]\n"
        "forces: {{gravity: [0, -3, -5]}}\n",
        bodies);
    return parse_scene(text, fmt::format("coil-{}", bodies), overrides);
}

namespace {

/// Sequence of human alpha-synuclein.
constexpr char const* alpha_synuclein =
    "MDVFMKGLSKAKEGVVAAAEKTKQGVAEAAGKTKEGVLYVGSKTKEGVVHGVATVAEKTKEQVTNVGGAVVTGVTAVAQKTVEGAGSIAAATGF"
    "VKKDQLGKNEEGAPQEGILEDMPVDPDNEAYEM"
    "PSEEGYQDYEPEA";
constexpr std::int64_t beads_of_chain = 140;

/// Returns the scene of copies of alpha-synuclein in a box.
std::string alpha_synucleins(std::int64_t chains, std::string const& box) {
    return fmt::format(
        "title: {0} of alpha-synuclein\n"
        "chains: [{{name: asyn, count: {0}, sequence: {1}, model: calvados2, conformation: "
        "self_avoiding, velocities: thermal}}]\n"
        "box: {2}\n"
        "forces: {{openmm: {{builder: calvados2, temperature: 300, ionic_strength: 0.15}}}}\n"
        "dynamics: {{integrator: g-baoab, step: 0.01, temperature: 300, friction: 0.01, seed: "
        "1}}\n",
        chains, alpha_synuclein, box);
}

/// Returns the number of whole chains for about this many beads.
std::int64_t chains_for(std::int64_t beads) {
    return std::max<std::int64_t>(1, (beads + beads_of_chain / 2) / beads_of_chain);
}

}  // namespace

std::int64_t beads_of_condensate(std::int64_t beads) { return beads_of_chain * chains_for(beads); }

Scene condensate_scene(std::int64_t beads, std::vector<std::string> const& overrides) {
    std::int64_t const chains = chains_for(beads);
    // The density is that of inputs/condensate.yaml; the edge is no smaller than the cutoff of 4 nm
    // allows.
    double const edge =
        chains == 1 ? 60.0 : std::max(8.1, 19.38 * std::cbrt(static_cast<double>(chains) / 100));
    return parse_scene(alpha_synucleins(chains, fmt::format("{{periodic: [{0}, {0}, {0}]}}", edge)),
                       fmt::format("condensate-{}", beads_of_chain * chains), overrides);
}

Scene single_chain_scene(std::vector<std::string> const& overrides) {
    return parse_scene(alpha_synucleins(1, "none"), "alpha-synuclein", overrides);
}

}  // namespace catena::command
