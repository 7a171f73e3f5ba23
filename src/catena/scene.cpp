// Implements Model: its text and the scene that the reader makes of it.
#include "catena/scene.hpp"

#include <fmt/format.h>

#include <utility>

#include "catena/chain_text.hpp"
#include "catena/content.hpp"
#include "catena/version.hpp"
#include "integrate/step_limit.hpp"
#include "reader/load_scene.hpp"
#include "scene/files.hpp"
#include "start/start_check.hpp"

namespace catena {

void Model::Content::add(Chain const& chain) {
    if (is_whole_)
        throw InputError("chains cannot be added to a scene that has been read", name_,
                         "write them there, or make a Model without a file");
    if (!chain.bodies.empty() && !chain.beads.empty())
        throw InputError("a chain has bodies and beads", name_ + ": Chain " + chain.name,
                         "fill one of the two lists");
    chains_ += text_of(chain);
    read_.reset();
}

void Model::Content::set(std::string const& change) {
    changes_.push_back(change);
    read_.reset();
}

Scene const& Model::Content::scene() const {
    if (!read_)
        read_ =
            parse_scene(chains_.empty() ? text_ : text_ + "chains:\n" + chains_, name_, changes_);
    return *read_;
}

Model::Model(Units units) : content_(std::make_unique<Content>(units)) {}
Model::Model(std::unique_ptr<Content> content) : content_(std::move(content)) {}
Model::~Model() = default;
Model::Model(Model const& other) : content_(std::make_unique<Content>(*other.content_)) {}
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(Model const& other) {
    if (this != &other) content_ = std::make_unique<Content>(*other.content_);
    return *this;
}
Model& Model::operator=(Model&&) noexcept = default;

Model Model::from_file(std::string const& path) {
    return with_public_errors([&] {
        scene::Node at;  // the file itself
        at.text = path;
        return Model(std::make_unique<Content>(scene::read_text_file(path, at), path));
    });
}
Model Model::from_text(std::string const& yaml) {
    return Model(std::make_unique<Content>(yaml, "scene in memory"));
}

Model& Model::add(Chain const& chain) {
    with_public_errors([&] { content_->add(chain); });
    return *this;
}
Model& Model::set(std::string const& key, std::string const& value) {
    content_->set(key + "=" + value);
    return *this;
}
Model& Model::set(std::string const& key, double value) {
    return set(key, fmt::format("{}", value));
}

std::int64_t Model::bodies() const {
    return with_public_errors([&] { return content_->scene().bodies(); });
}
std::vector<std::string> Model::notes() const {
    return with_public_errors([&] { return content_->scene().notes; });
}

std::vector<std::string> Model::check() const {
    return with_public_errors([&] {
        auto const alone = serial_communicator();
        Scene scene = content_->scene();
        choose_backend(scene, *alone);
        if (!scene.relax) refuse_coinciding(scene, *alone);
        if (std::string const note = note_of_step(scene, estimate_step_limit(scene)); !note.empty())
            scene.note(note);
        return scene.notes;
    });
}

std::string version() { return CATENA_VERSION; }

}  // namespace catena
