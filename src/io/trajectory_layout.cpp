// Implements the creation and the opening of a trajectory's groups and datasets.
#include "io/trajectory_layout.hpp"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "error.hpp"
#include "io/site_names.hpp"

namespace catena::hdf5 {
namespace {

constexpr std::int64_t trajectory_version = 1;
std::string const position_group = "particles/trajectory/position";

/// Texts of the attributes `unit`.
struct Units {
    std::string length, time, velocity, mass, torque, force, rate;
};

Units units_of(bool si) {
    if (si) return {"m", "s", "m s-1", "kg", "N m", "N", "rad s-1"};
    return {"nm", "ps", "nm ps-1", "u", "kJ mol-1", "kJ mol-1 nm-1", "rad ps-1"};
}

std::string author() {
    passwd const* const user = ::getpwuid(::geteuid());
    return user != nullptr ? user->pw_name : "unknown";
}

/// Creates the groups and datasets of a new file.
class Builder {
  public:
    Builder(Place const& root, Topology const& topology, TrajectoryContents const& contents)
        : root_(root), topology_(topology), contents_(contents), units_(units_of(contents.si)) {}

    TrajectorySeries build() {
        describe_file();
        Group const particles = make_group(root_, "particles");
        Group const sites = make_group(at(particles), "trajectory");
        add_element(at(sites), "position", {contents_.sites, 3}, units_.length, series_.position,
                    "W, unwrapped");
        if (contents_.velocities)
            add_element(at(sites), "velocity", {contents_.sites, 3}, units_.velocity,
                        series_.velocity, "W");
        add_box(at(sites));
        put_unit(at(put_array(at(sites), "mass", topology_.mass)), units_.mass);
        std::vector<std::int64_t> id(contents_.sites);
        std::iota(id.begin(), id.end(), 1);
        put_array(at(sites), "id", id);
        if (is_branched() || is_cross_linked()) add_connectivity(sites);
        add_own_group();
        return std::move(series_);
    }

  private:
    template <class Owner>
    Place at(Owner const& owner) const {
        return {owner.get(), root_.file, root_.doing};
    }

    /// Writes /h5md: version, author, creator and module of units.
    void describe_file() {
        Group const h5md = make_group(root_, "h5md");
        put_attribute(at(h5md), "version", std::array<std::int64_t, 2>{1, 1});
        Group const who = make_group(at(h5md), "author");
        put_text(at(who), "name", author());
        Group const creator = make_group(at(h5md), "creator");
        put_text(at(creator), "name", "catena");
        put_text(at(creator), "version", CATENA_VERSION);
        Group const modules = make_group(at(h5md), "modules");
        Group const units = make_group(at(modules), "units");
        put_attribute(at(units), "version", std::array<std::int64_t, 2>{1, 0});
        put_text(at(units), "system", "SI");
    }

    /// Writes /catena, Catena's own group.
    void add_own_group() {
        Group const own = make_group(root_, "catena");
        put_attribute(at(own), "format_version", trajectory_version);
        put_text(at(own), "title", topology_.title);
        put_text(at(own), "length_unit", units_.length);
        describe_chains(at(own));
        if (!topology_.members.empty()) describe_members(at(own));
        if (is_branched()) describe_branches(at(own));
        if (is_cross_linked()) describe_crosslinks(at(own));
        if (contents_.bodies > 0) {
            Group const element = add_element(at(own), "orientation", {contents_.bodies, 4}, "",
                                              series_.orientation, "w x y z, body axes to W");
            std::vector<hsize_t> const site(topology_.bodies.begin(), topology_.bodies.end());
            put_array(at(element), "site", H5T_NATIVE_HSIZE, site.data(),
                      std::span(&contents_.bodies, 1));
        }
        add_coordinates(at(own));
        if (!contents_.joint_forces) return;
        std::string const frame = "W, on each body at its inboard joint; at the first of its sites";
        add_element(at(own), "joint_torque", {contents_.sites, 3}, units_.torque, series_.torque,
                    frame);
        add_element(at(own), "joint_force", {contents_.sites, 3}, units_.force, series_.force,
                    frame);
        if (contents_.tips == 0) return;
        std::string const at_tip = "W, on the last body at its joint to the ground";
        Group const torque = add_element(at(own), "tip_torque", {contents_.tips, 3}, units_.torque,
                                         series_.tip_torque, at_tip);
        Group const force = add_element(at(own), "tip_force", {contents_.tips, 3}, units_.force,
                                        series_.tip_force, at_tip);
        for (Group const* const element : {&torque, &force})
            put_array(at(*element), "chain", topology_.tips);
    }

    /// Adds the coordinates of bodies and of joints.
    void add_coordinates(Place const& own) {
        std::string const at_centre = "W, of the centre of mass";
        if (contents_.body_states) {
            add_element(own, "body_position", {contents_.bodies, 3}, units_.length,
                        series_.body_position, at_centre);
            add_element(own, "body_velocity", {contents_.bodies, 3}, units_.velocity,
                        series_.body_velocity, at_centre);
            add_element(own, "angular_velocity", {contents_.bodies, 3}, units_.rate,
                        series_.angular_velocity, "B, body axes");
        }
        if (!contents_.joint_states) return;
        add_element(own, "joint_position", {contents_.bodies, 4}, "", series_.joint_position,
                    "of the inboard joint, as q in the scene");
        add_element(own, "joint_rate", {contents_.bodies, 3}, "", series_.joint_rate,
                    "of the inboard joint, as qd in the scene");
    }

    /// Writes /catena/chains.
    void describe_chains(Place const& own) {
        Group const chains = make_group(own, "chains");
        std::vector<std::int64_t> first, count, beads, ring, replica;
        std::vector<std::string> name;
        for (Topology::Chain const& chain : topology_.chains) {
            first.push_back(chain.first);
            count.push_back(chain.count);
            beads.push_back(chain.beads);
            ring.push_back(chain.ring);
            replica.push_back(chain.replica + 1);
            name.push_back(chain.name);
        }
        put_array(at(chains), "first", first);
        put_array(at(chains), "count", count);
        put_array(at(chains), "beads", beads);
        put_array(at(chains), "ring", ring);
        put_array(at(chains), "name", name);
        if (!replica.empty() && replica.back() > 1) put_array(at(chains), "replica", replica);
    }

    bool is_branched() const {
        return std::any_of(topology_.chains.begin(), topology_.chains.end(),
                           [](Topology::Chain const& chain) { return !chain.parent.empty(); });
    }

    bool is_cross_linked() const {
        return std::any_of(topology_.chains.begin(), topology_.chains.end(),
                           [](Topology::Chain const& chain) { return !chain.crosslinks.empty(); });
    }

    /// Writes /connectivity/bonds of H5MD.
    void add_connectivity(Group const& sites) {
        std::vector<std::int64_t> ids;
        for (auto const& [from, to] : SiteNames(topology_).bonds())
            ids.insert(ids.end(), {from + 1, to + 1});
        Group const connectivity = make_group(root_, "connectivity");
        std::array<hsize_t, 2> const shape{ids.size() / 2, 2};
        Dataset const bonds =
            put_array(at(connectivity), "bonds", H5T_NATIVE_INT64, ids.data(), shape);
        put_reference(at(bonds), "particles_group", at(sites));
    }

    /// Writes /catena/parent.
    void describe_branches(Place const& own) {
        std::vector<std::int64_t> parent;
        for (Topology::Chain const& chain : topology_.chains)
            for (std::int64_t k = 0; k < chain.count; ++k)
                parent.push_back(chain.parent.empty() ? k - 1
                                                      : chain.parent[static_cast<std::size_t>(k)]);
        put_array(own, "parent", parent);
    }

    /// Writes /catena/crosslinks.
    void describe_crosslinks(Place const& own) {
        std::vector<std::int64_t> sites;
        for (Topology::Chain const& chain : topology_.chains)
            for (auto const& [a, b] : chain.crosslinks)
                sites.insert(sites.end(), {chain.first + a, chain.first + b});
        put_array(own, "crosslinks", sites);
    }

    /// Writes /catena/members.
    void describe_members(Place const& own) {
        SiteNames const names(topology_);
        Group const group = make_group(own, "members");
        std::vector<std::string> identifier;
        std::vector<std::int64_t> chain, member, place, number;
        for (std::size_t m = 0; m < names.members(); ++m) {
            identifier.push_back(names.identifier(m));
            chain.push_back(static_cast<std::int64_t>(names.chain(m)));
        }
        for (ResidueRun const& run : names.runs())
            for (std::int64_t k = 0; k < run.count; ++k) {
                member.push_back(static_cast<std::int64_t>(run.member));
                place.push_back(run.place + run.step * k);
                number.push_back(run.number + run.step * k);
            }
        put_array(at(group), "identifier", identifier);
        put_array(at(group), "chain", chain);
        put_array(at(group), "member", member);
        put_array(at(group), "place", place);
        put_array(at(group), "number", number);
    }

    /// Creates a group {step, time, value}. The first call creates step and time; later calls link
    /// them.
    Group add_element(Place const& parent, std::string const& name, std::vector<hsize_t> row,
                      std::string const& unit, Series& value, std::string const& frame) {
        Group element = make_group(parent, name);
        if (!series_.step) {
            series_.step = Series::create(at(element), "step", H5T_NATIVE_INT64, {});
            series_.time = Series::create(at(element), "time", H5T_NATIVE_DOUBLE, {});
            put_unit(at(series_.time), units_.time);
        } else {
            for (std::string const shared : {"step", "time"}) {
                std::string const source = std::string(position_group).append("/").append(shared);
                check(H5Lcreate_hard(root_.id, source.c_str(), element.get(), shared.c_str(),
                                     H5P_DEFAULT, H5P_DEFAULT),
                      root_.file, root_.doing);
            }
        }
        value = Series::create(at(element), "value", H5T_NATIVE_DOUBLE, std::move(row));
        if (!unit.empty()) put_unit(at(value), unit);
        if (!frame.empty()) put_text(at(value), "frame", frame);
        return element;
    }

    /// Writes the box, with edges in every frame if it is periodic.
    void add_box(Place const& sites) {
        Group const box = make_group(sites, "box");
        put_attribute(at(box), "dimension", std::int64_t{3});
        put_texts(at(box), "boundary",
                  std::vector<std::string>(3, contents_.periodic ? "periodic" : "none"));
        if (contents_.periodic)
            add_element(at(box), "edges", {3}, units_.length, series_.edges, "");
    }

    Place const& root_;
    Topology const& topology_;
    TrajectoryContents const& contents_;
    Units units_;
    TrajectorySeries series_;
};

[[noreturn]] void refuse(Place const& root, std::string const& what) {
    throw InputError(
        "the trajectory " + what, root.file,
        std::string("restart with the scene that wrote it, or ") + Continuation::way_beside);
}

/// Throws InputError if the presence of `group` differs from `wanted`.
void require(Place const& root, std::string const& group, bool wanted, std::string const& what) {
    bool const present = has(root, group);
    if (present != wanted)
        refuse(root, std::string(present ? "contains " : "contains no ") + what +
                         (present ? " that" : " but") + " this run " +
                         (wanted ? "writes them" : "does not write"));
}

}  // namespace

TrajectoryContents contents_of(Topology const& topology, bool velocities, bool joint_forces) {
    TrajectoryContents contents;
    contents.velocities = velocities;
    contents.joint_forces = joint_forces;
    contents.periodic = topology.box.has_value();
    contents.si = topology.si;
    contents.sites = topology.mass.size();
    contents.tips = topology.tips.size();
    contents.bodies = topology.bodies.size();
    contents.body_states = topology.body_states && contents.bodies > 0;
    contents.joint_states = topology.joint_states && contents.bodies > 0;
    return contents;
}

std::vector<Series*> TrajectorySeries::present() {
    std::vector<Series*> all;
    for (Series* series : {&position, &velocity, &edges, &orientation, &body_position,
                           &body_velocity, &angular_velocity, &joint_position, &joint_rate, &torque,
                           &force, &tip_torque, &tip_force, &time, &step})
        if (*series) all.push_back(series);
    return all;
}

TrajectorySeries create_trajectory(Place const& root, Topology const& topology,
                                   TrajectoryContents const& contents) {
    return Builder(root, topology, contents).build();
}

TrajectorySeries open_trajectory(Place const& root, TrajectoryContents const& contents) {
    auto const text_of = [&](std::string const& object,
                             std::string const& attribute) -> std::string {
        if (!has(root, object)) return "";
        Object const opened(H5Oopen(root.id, object.c_str(), H5P_DEFAULT));
        return opened ? get_text({opened.get(), root.file, root.doing}, attribute) : "";
    };
    if (text_of("h5md/creator", "name") != "catena" || !has(root, "catena"))
        refuse(root, "was not written by Catena");
    std::string const position = position_group + "/value";
    if (!has(root, position)) refuse(root, "has no positions");
    TrajectorySeries series;
    series.position = Series::open(root, position, H5T_NATIVE_DOUBLE);
    if (series.position.row() != std::vector<hsize_t>{contents.sites, 3})
        refuse(
            root,
            "has " +
                (series.position.row().empty() ? "no" : std::to_string(series.position.row()[0])) +
                " sites but the scene " + std::to_string(contents.sites));
    std::string const unit =
        text_of("catena", "length_unit");  // absent in files of earlier versions
    if (!unit.empty() && unit != units_of(contents.si).length)
        refuse(root, "is in " + unit + ", unlike the scene");
    require(root, "particles/trajectory/velocity", contents.velocities, "velocities");
    require(root, "particles/trajectory/box/edges", contents.periodic, "box edges");
    require(root, "catena/orientation", contents.bodies > 0, "orientations");
    require(root, "catena/joint_force", contents.joint_forces, "joint forces");
    require(root, "catena/angular_velocity", contents.body_states, "coordinates of bodies");
    require(root, "catena/joint_position", contents.joint_states, "coordinates of joints");
    series.step = Series::open(root, position_group + "/step", H5T_NATIVE_INT64);
    series.time = Series::open(root, position_group + "/time", H5T_NATIVE_DOUBLE);
    if (contents.velocities)
        series.velocity =
            Series::open(root, "particles/trajectory/velocity/value", H5T_NATIVE_DOUBLE);
    if (contents.periodic)
        series.edges =
            Series::open(root, "particles/trajectory/box/edges/value", H5T_NATIVE_DOUBLE);
    if (contents.bodies > 0)
        series.orientation = Series::open(root, "catena/orientation/value", H5T_NATIVE_DOUBLE);
    if (series.orientation && series.orientation.row()[0] != contents.bodies)
        refuse(root, "has another number of bodies");
    auto const open = [&](Series& to, bool wanted, char const* name) {
        if (wanted)
            to = Series::open(root, std::string("catena/") + name + "/value", H5T_NATIVE_DOUBLE);
    };
    open(series.body_position, contents.body_states, "body_position");
    open(series.body_velocity, contents.body_states, "body_velocity");
    open(series.angular_velocity, contents.body_states, "angular_velocity");
    open(series.joint_position, contents.joint_states, "joint_position");
    open(series.joint_rate, contents.joint_states, "joint_rate");
    if (!contents.joint_forces) return series;
    series.torque = Series::open(root, "catena/joint_torque/value", H5T_NATIVE_DOUBLE);
    series.force = Series::open(root, "catena/joint_force/value", H5T_NATIVE_DOUBLE);
    if (!has(root, "catena/tip_force"))
        return series;  // no tips, or a file of a version that did not write them
    series.tip_torque = Series::open(root, "catena/tip_torque/value", H5T_NATIVE_DOUBLE);
    series.tip_force = Series::open(root, "catena/tip_force/value", H5T_NATIVE_DOUBLE);
    if (series.tip_force.row()[0] != contents.tips) refuse(root, "has another number of tips");
    return series;
}

}  // namespace catena::hdf5
