// Implements the picture of `catena check --picture`.
#include <fmt/format.h>

#include <filesystem>

#include "command/commands.hpp"
#include "console/option_values.hpp"
#include "domains/rigid_entry.hpp"
#include "error.hpp"
#include "io/output.hpp"
#include "mpi/first_rank.hpp"
#include "page/domain_picture.hpp"
#include "reader/load_scene.hpp"

namespace catena::command {
namespace {

/// A chain's confidences and domains in the form of the page.
DomainPicture picture_of(PredictedChain const& chain) {
    scene::Prediction const& found = *chain.found;
    return {fmt::format("Rigid domains of chain {}", chain.name),
            found.plddt,
            [&found](std::size_t i, std::size_t j) { return found.error.at(i, j); },
            found.thresholds.plddt,
            found.thresholds.pae,
            found.domains};
}

}  // namespace

void draw_domains(CheckRequest const& request, Communicator const& communicator) {
    if (request.picture.empty()) return;
    on_first_rank(communicator, [&] {
        require_writable("--picture", request.picture);
        std::vector<PredictedChain> const chains =
            load_predictions(request.scene, overrides_of(request));
        if (chains.empty())
            throw InputError("no chain of the scene decides its rigid domains by a prediction",
                             "--picture " + request.picture,
                             "write `rigid: {pae: FILE.json}`, or leave --picture out");
        std::vector<DomainPicture> pictures;
        for (PredictedChain const& chain : chains) pictures.push_back(picture_of(chain));
        write_text_file(request.picture, domain_pictures(pictures));
    });
}

}  // namespace catena::command
