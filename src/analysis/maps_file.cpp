// Writes contact maps and the series of all copies to HDF5.
#include <algorithm>
#include <array>
#include <cstdio>

#include "analysis/analysis.hpp"
#include "io/hdf5_data.hpp"
#include "io/output_file.hpp"

namespace catena::analysis {
namespace {

using namespace hdf5;

std::string const writing = "write the contact maps";

/// Returns the name of a group for a kind; a slash would be a path.
std::string group_name(std::string name) {
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
}

/// Writer of the groups of one file.
class MapsFile {
  public:
    MapsFile(Analysis const& analysis, std::string const& draft, std::string const& file)
        : analysis_(analysis),
          file_(file),
          handle_(check(hdf5::create_anew(draft, H5P_DEFAULT, H5P_DEFAULT), file, writing)) {}

    void write() {
        Place const root = at(handle_);
        put_text(root, "format", "catena analysis");
        put_attribute(root, "version", std::int64_t{1});
        put_attribute(root, "sites_a_row", analysis_.sites_a_row);
        close(put_array(root, "step", analysis_.steps));
        close(put_array(root, "time", analysis_.times));
        if (analysis_.cutoff > 0) write_maps(root);
        write_series(root);
        flush_to_disk(handle_, file_, writing);
        check(handle_.close(), file_, writing);
    }

  private:
    template <class Owner>
    Place at(Owner const& owner) const {
        return {owner.get(), file_, writing};
    }
    void close(Dataset data) const { check(data.close(), file_, writing); }
    void put(Place const& group, std::string const& name, std::vector<double> const& values,
             std::array<hsize_t, 2> const& shape) const {
        close(put_array(group, name, H5T_NATIVE_DOUBLE, values.data(), shape));
    }

    void write_maps(Place const& root) const {
        Group const contacts = make_group(root, "contacts"),
                    within = make_group(at(contacts), "within"),
                    between = make_group(at(contacts), "between");
        close(put_array(at(contacts), "cutoff", std::span(&analysis_.cutoff, 1)));
        put_unit(at(contacts), analysis_.length_unit);
        for (ContactMap const& map : analysis_.maps) {
            std::string name = group_name(analysis_.kinds[map.parts.first].name);
            if (!map.parts.within)
                name += " -- " + group_name(analysis_.kinds[map.parts.second].name);
            Group const group = make_group(at(map.parts.within ? within : between), name);
            put(at(group), "mean", map.mean, {map.rows, map.columns});
            put(at(group), "error", map.error, {map.rows, map.columns});
        }
    }

    void write_series(Place const& root) const {
        Group const all = make_group(root, "series");
        for (Series const& series : analysis_.series) {
            Group const group = has(at(all), series.name)
                                    ? Group(H5Gopen2(all.get(), series.name.c_str(), H5P_DEFAULT))
                                    : make_group(at(all), series.name);
            put(at(group), group_name(series.kind), series.values.values(),
                {analysis_.steps.size(), series.values.copies()});
        }
    }

    Analysis const& analysis_;
    std::string const& file_;
    File handle_;
};

}  // namespace

void write_maps(Analysis const& analysis, std::string const& file) {
    Quiet const quiet;
    std::string const draft = file + ".part";
    try {
        MapsFile(analysis, draft, file).write();
        rename_file(draft, file);
    } catch (...) {
        std::remove(draft.c_str());
        throw;
    }
}

}  // namespace catena::analysis
