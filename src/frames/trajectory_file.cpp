// Implements the reader of trajectory.h5md by calls of the HDF5 C library.
#include "frames/trajectory_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "error.hpp"
#include "frames/member_order.hpp"
#include "io/hdf5_data.hpp"
#include "io/output_file.hpp"
#include "io/trial.hpp"

namespace catena {
namespace {

using namespace hdf5;

/// Largest ratio of compression to believe: deflate compresses at most 1032 bytes into one.
constexpr double best_compression = 1100;
std::string const reading = "read the trajectory";
std::string const position_group = "particles/trajectory/position/";

/// Path of the trajectory in the folder of a run, or the file itself.
std::string file_of(std::string const& place) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(place, ignored)) return place;
    return (std::filesystem::path(place) / "trajectory.h5md").string();
}

/// Returns the extents of a dataset.
std::vector<hsize_t> shape_of(Dataset const& data, Place const& place) {
    Space const space(check(H5Dget_space(data.get()), place.file, place.doing));
    std::vector<hsize_t> shape(
        static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.get()))));
    check(H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr), place.file, place.doing);
    return shape;
}

Dataset open_data(Place const& place, std::string const& name) {
    return Dataset(check(H5Dopen2(place.id, name.c_str(), H5P_DEFAULT), place.file + ", " + name,
                         place.doing));
}

/// Returns the number of entries of a one-dimensional dataset. Throws InputError if the dataset has
/// another shape or claims more than the file can hold, as damaged ones may.
std::size_t entries_of(Dataset const& data, Place const& place, std::string const& name) {
    std::vector<hsize_t> const shape = shape_of(data, place);
    Type const type(check(H5Dget_type(data.get()), place.file, place.doing));
    double const claimed = shape.size() == 1 ? static_cast<double>(shape[0]) *
                                                   static_cast<double>(H5Tget_size(type.get()))
                                             : INFINITY;
    if (claimed > best_compression * static_cast<double>(std::filesystem::file_size(place.file)))
        throw InputError("the trajectory is damaged, its " + name + " claims more than it holds",
                         place.file, "run the scene again");
    return shape[0];
}

/// Reads a one-dimensional dataset of numbers as `type`.
template <class Number>
std::vector<Number> read_list(Place const& place, std::string const& name, hid_t type) {
    Dataset const data = open_data(place, name);
    std::vector<Number> numbers(entries_of(data, place, name));
    if (!numbers.empty())
        check(H5Dread(data.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
              place.file + ", " + name, place.doing);
    return numbers;
}

/// Reads a one-dimensional dataset of texts of fixed length.
std::vector<std::string> read_texts(Place const& place, std::string const& name) {
    Dataset const data = open_data(place, name);
    Type const type(check(H5Dget_type(data.get()), place.file, place.doing));
    std::size_t const count = entries_of(data, place, name);
    if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) > 0)
        fail(place.file + ", " + name, place.doing);
    std::size_t const length = H5Tget_size(type.get());
    std::string all(length * count, '\0');
    if (count > 0)
        check(H5Dread(data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()),
              place.file + ", " + name, place.doing);
    std::vector<std::string> texts;
    for (std::size_t k = 0; k < count; ++k) {
        std::string const text = all.substr(k * length, length);
        texts.push_back(text.substr(0, text.find('\0')));
    }
    return texts;
}

/// Reads row `frame` of a series of doubles.
void read_row(Place const& place, Series const& series, std::size_t frame, double* values) {
    std::vector<hsize_t> start{frame}, count{1};
    start.resize(series.row().size() + 1, 0);
    count.insert(count.end(), series.row().begin(), series.row().end());
    Space const in_file(check(H5Dget_space(series.get()), place.file, place.doing));
    check(H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                              nullptr),
          place.file, place.doing);
    Space const in_memory(
        check(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), place.file,
              place.doing));
    check(H5Dread(series.get(), H5T_NATIVE_DOUBLE, in_memory.get(), in_file.get(), H5P_DEFAULT,
                  values),
          place.file, place.doing);
}

std::string attribute_of(Place const& root, std::string const& object, std::string const& name) {
    if (!has(root, object)) return "";
    Object const opened(H5Oopen(root.id, object.c_str(), H5P_DEFAULT));
    return opened ? get_text({opened.get(), root.file, root.doing}, name) : "";
}

}  // namespace

/// The file and its growing datasets.
struct TrajectoryFile::Series {
    Quiet quiet;
    File file;
    hdf5::Series position, edges;
};

TrajectoryFile::TrajectoryFile(std::string const& place, SiteOrder order) : name_(file_of(place)) {
    std::error_code ignored;
    if (!std::filesystem::exists(name_, ignored))
        throw InputError("there is no trajectory", name_, "name the folder of a run");
    auto const look = [&] {
        open();
        series_->position.look_at_last({series_->file.get(), name_, reading});
    };
    if (std::string const end = trial(look, limits_for_file(name_)); !end.empty())
        throw InputError("the trajectory is damaged, HDF5 breaks on it: " + end, name_,
                         "run the scene again");
    try {
        open();
    } catch (ComputationError const& error) {
        throw InputError("the trajectory is damaged, " + std::string(error.what()), name_,
                         "run the scene again");
    }
    if (steps_.empty())
        throw InputError("the trajectory has no frames", name_, "let the run reach its first one");
    read_residues();
    Snapshot first;
    read(0, first);
    topology_.box = first.box;
    if (order == SiteOrder::stored) return;
    MemberOrder members = by_members(topology_);
    topology_ = std::move(members.topology);
    site_ = std::move(members.site);
}

TrajectoryFile::~TrajectoryFile() = default;

void TrajectoryFile::open() {
    series_ = std::make_unique<Series>();
    series_->file = File(H5Fopen(name_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    std::string const why = series_->file ? "" : cause();  // before the next call forgets it
    if (why.find("truncated") != std::string::npos)
        throw InputError("the trajectory was cut, its end is missing", name_,
                         "copy it again from the run's folder, or run the scene again");
    if (!series_->file && H5Fis_hdf5(name_.c_str()) == 0)
        throw InputError("the file is no trajectory of Catena", name_,
                         "give the folder of a run, or the trajectory.h5md in it");
    if (!series_->file)
        throw InputError("the trajectory cannot be opened, " + why, name_,
                         "name a run's folder, or wait until the run that writes it has ended");
    Place const root{series_->file.get(), name_, reading};
    if (attribute_of(root, "h5md/creator", "name") != "catena" || !has(root, "catena/chains") ||
        !has(root, position_group + "value"))
        throw InputError("the trajectory was not written by Catena", name_,
                         "name the folder of a run");
    topology_.title = attribute_of(root, "catena", "title");
    topology_.si = attribute_of(root, "catena", "length_unit") == "m";
    series_->position = hdf5::Series::open(root, position_group + "value", H5T_NATIVE_DOUBLE);
    bool const periodic = has(root, "particles/trajectory/box/edges");
    if (periodic)
        series_->edges =
            hdf5::Series::open(root, "particles/trajectory/box/edges/value", H5T_NATIVE_DOUBLE);
    steps_ = read_list<std::int64_t>(root, position_group + "step", H5T_NATIVE_INT64);
    times_ = read_list<double>(root, position_group + "time", H5T_NATIVE_DOUBLE);
    read_chains();
    std::size_t whole =
        std::min<std::size_t>({steps_.size(), times_.size(), series_->position.frames(root)});
    if (periodic) whole = std::min<std::size_t>(whole, series_->edges.frames(root));
    steps_.resize(whole);
    times_.resize(whole);
}

void TrajectoryFile::read_chains() {
    Place const root{series_->file.get(), name_, reading};
    topology_.mass = read_list<double>(root, "particles/trajectory/mass", H5T_NATIVE_DOUBLE);
    auto const list = [&](char const* name) {
        return read_list<std::int64_t>(root, std::string("catena/chains/") + name,
                                       H5T_NATIVE_INT64);
    };
    std::vector<std::int64_t> const first = list("first"), count = list("count"),
                                    beads = list("beads"), ring = list("ring");
    std::vector<std::int64_t> const replica = has(root, "catena/chains/replica")
                                                  ? list("replica")
                                                  : std::vector<std::int64_t>(first.size(), 1);
    std::vector<std::string> const names = read_texts(root, "catena/chains/name");
    topology_.chains.clear();
    std::int64_t sites = 0;
    bool sound = count.size() == first.size() && beads.size() == first.size() &&
                 ring.size() == first.size() && names.size() == first.size() &&
                 replica.size() == first.size();
    for (std::size_t c = 0; sound && c < first.size(); ++c) {
        sound = first[c] == sites && count[c] >= 0;
        sites += count[c];
        topology_.chains.push_back(
            {names[c], first[c], count[c], beads[c] != 0, ring[c] != 0, replica[c] - 1});
    }
    std::vector<hsize_t> const row{topology_.mass.size(), 3};
    auto const is_mass = [](double mass) { return std::isfinite(mass) && mass > 0; };
    sound = sound && sites == std::ssize(topology_.mass) && series_->position.row() == row &&
            std::all_of(topology_.mass.begin(), topology_.mass.end(), is_mass) &&
            (!series_->edges || series_->edges.row() == std::vector<hsize_t>{3});
    if (!sound)
        throw InputError("the trajectory's chains, masses and positions do not fit together", name_,
                         "run the scene again");
    if (has(root, "catena/members")) read_members();
    if (has(root, "catena/parent")) read_branches();
    if (has(root, "catena/crosslinks")) read_crosslinks();
}

void TrajectoryFile::read_crosslinks() {
    Place const root{series_->file.get(), name_, reading};
    auto const sites = read_list<std::int64_t>(root, "catena/crosslinks", H5T_NATIVE_INT64);
    auto chain = topology_.chains.begin();
    bool sound = sites.size() % 2 == 0;
    for (std::size_t i = 0; sound && i < sites.size(); i += 2) {
        std::int64_t const a = sites[i], b = sites[i + 1];
        while (chain != topology_.chains.end() && a >= chain->first + chain->count) ++chain;
        sound = chain != topology_.chains.end() && a >= chain->first && b > a &&
                b < chain->first + chain->count;
        if (sound) chain->crosslinks.push_back({a - chain->first, b - chain->first});
    }
    if (!sound)
        throw InputError("the trajectory is damaged, its cross-links do not fit its chains", name_,
                         "run the scene again");
}

void TrajectoryFile::read_branches() {
    Place const root{series_->file.get(), name_, reading};
    auto const parent = read_list<std::int64_t>(root, "catena/parent", H5T_NATIVE_INT64);
    bool sound = parent.size() == topology_.mass.size();
    for (std::size_t c = 0; sound && c < topology_.chains.size(); ++c) {
        Topology::Chain& chain = topology_.chains[c];
        bool branched = false;
        for (std::int64_t k = 0; sound && k < chain.count; ++k) {
            std::int64_t const on = parent[static_cast<std::size_t>(chain.first + k)];
            sound = k == 0 ? on == -1 : on >= 0 && on < k;
            branched = branched || on != k - 1;
        }
        if (branched)
            chain.parent.assign(parent.begin() + chain.first,
                                parent.begin() + chain.first + chain.count);
    }
    if (!sound)
        throw InputError(
            "the trajectory is damaged, the branches of its chains do not fit its sites", name_,
            "run the scene again");
}

void TrajectoryFile::read_members() {
    Place const root{series_->file.get(), name_, reading};
    auto const list = [&](char const* name) {
        return read_list<std::int64_t>(root, std::string("catena/members/") + name,
                                       H5T_NATIVE_INT64);
    };
    std::optional<Members> members =
        members_of_sites(topology_, read_texts(root, "catena/members/identifier"), list("member"),
                         list("place"), list("number"));
    if (!members)
        throw InputError(
            "the trajectory is damaged, the members of its chains do not fit its sites", name_,
            "run the scene again");
    topology_.members = std::move(*members);
}

void TrajectoryFile::read_residues() {
    std::string const pdb = (std::filesystem::path(name_).parent_path() / "topology.pdb").string();
    topology_.residue.assign(topology_.mass.size(), "UNK");
    std::error_code ignored;
    if (!std::filesystem::exists(pdb, ignored)) return;
    std::string const text = read_text_file(pdb);
    std::vector<std::string> residues;
    for (std::size_t begin = 0; begin < text.size();) {
        std::size_t const end = std::min(text.find('\n', begin), text.size());
        if (end - begin > 20 && text.compare(begin, 6, "ATOM  ") == 0)
            residues.push_back(text.substr(begin + 17, 3));
        begin = end + 1;
    }
    if (residues.size() != topology_.residue.size())
        throw InputError("the topology has " + std::to_string(residues.size()) +
                             " sites, but the trajectory " +
                             std::to_string(topology_.residue.size()),
                         pdb, "put the run's own file back, or remove it");
    topology_.residue = std::move(residues);
    has_residues_ = true;
}

void TrajectoryFile::read(std::size_t frame, Snapshot& snapshot) const {
    Place const root{series_->file.get(), name_, reading};
    auto const is_finite = [](Vec3 const& x) {
        return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
    };
    snapshot.position.resize(topology_.mass.size());
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    try {
        if (!snapshot.position.empty())
            read_row(root, series_->position, frame, snapshot.position.front().data);
        snapshot.box.reset();
        if (series_->edges) read_row(root, series_->edges, frame, snapshot.box.emplace().data);
    } catch (ComputationError const& error) {
        throw InputError("the trajectory is damaged, " + std::string(error.what()), name_,
                         "leave the frame out with --first or --last");
    }
    if (!site_.empty()) {
        std::vector<Vec3> const stored = snapshot.position;
        for (std::size_t k = 0; k < site_.size(); ++k) snapshot.position[k] = stored[site_[k]];
    }
    bool const good_box = !snapshot.box || (is_finite(*snapshot.box) && (*snapshot.box)[0] > 0 &&
                                            (*snapshot.box)[1] > 0 && (*snapshot.box)[2] > 0);
    if (!good_box || !std::all_of(snapshot.position.begin(), snapshot.position.end(), is_finite))
        throw InputError("frame " + std::to_string(frame) + " holds numbers that are not finite",
                         name_, "leave it out with --first or --last");
}

}  // namespace catena
