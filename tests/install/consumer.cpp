// A program that uses the installed library: says what a scene file holds.
#include <catena/catena.hpp>
#include <cstdio>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    if (catena::version() != FOUND_VERSION) return 3;
    try {
        auto const model = catena::Model::from_file(argv[1]);
        std::printf("%lld bodies, %zu notes\n", static_cast<long long>(model.bodies()),
                    model.notes().size());
        return 0;
    } catch (catena::Error const& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return error.reason() == catena::Error::Reason::input ? 2 : 1;
    }
}
