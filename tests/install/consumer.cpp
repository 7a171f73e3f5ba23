// A program that uses the installed library: says what a scene holds.
#include <catena/error.hpp>
#include <catena/reader/load_scene.hpp>
#include <cstdio>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    try {
        catena::Scene const scene = catena::load_scene(argv[1]);
        std::printf("%s: %zu chains, %lld bodies\n", scene.title.c_str(), scene.chains.size(),
                    static_cast<long long>(scene.bodies()));
        return 0;
    } catch (catena::InputError const& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
