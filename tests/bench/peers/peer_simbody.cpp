// Simbody's forward dynamics for `catena bench peers`. Usage: peer-simbody CHAIN ACCELERATIONS
// (peer.py describes both, and the questions)
#include <Simbody.h>
#include <sys/resource.h>

#include <chrono>
#include <exception>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace {

using SimTK::Rotation;
using SimTK::Transform;
using SimTK::Vec3;

enum Kind { revolute, ball, slide, universal };

struct Row {
    double mass, com[3], inertia[6], kind, axis[3], rotation[9], translation[3], q[4], qd[3],
        torque[3], wrench_torque[3], wrench_force[3];
};

Vec3 vector(double const* v) { return {v[0], v[1], v[2]}; }

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

std::vector<Row> rows_of(char const* file, Vec3& gravity) {
    std::ifstream in(file, std::ios::binary);
    double head[sizeof(Row) / sizeof(double)] = {};
    in.read(reinterpret_cast<char*>(head), sizeof(head));
    if (head[0] * sizeof(double) != sizeof(Row))
        throw std::runtime_error("not a table of rows of 42 numbers");
    gravity = vector(head + 2);
    std::vector<Row> rows(static_cast<std::size_t>(head[1]));
    in.read(reinterpret_cast<char*>(rows.data()),
            static_cast<std::streamsize>(rows.size() * sizeof(Row)));
    if (!in) throw std::runtime_error("the table ends too early");
    return rows;
}

class Chain {
  public:
    explicit Chain(std::vector<Row> const& rows, Vec3 const& gravity)
        : rows_(rows), matter_(system_), forces_(system_), loads_(forces_, matter_) {
        SimTK::Force::UniformGravity(forces_, matter_, gravity);
        for (Row const& row : rows) add(row);
        state_ = system_.realizeTopology();
        system_.realizeModel(state_);
        for (std::size_t k = 0; k < rows.size(); ++k) place(rows[k], mobod(k));
        system_.realize(state_, SimTK::Stage::Position);
        for (std::size_t k = 0; k < rows.size(); ++k) load(rows[k], mobod(k));
    }
    void evaluate() {
        state_.invalidateAllCacheAtOrAbove(SimTK::Stage::Position);
        system_.realize(state_, SimTK::Stage::Acceleration);
    }
    std::vector<double> accelerations() const {
        std::vector<double> all;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            SimTK::MobilizedBody const& body = mobod(k);
            SimTK::Vector u = body.getUDotAsVector(state_);
            if (rows_[k].kind == ball)
                u = SimTK::Vector(~body.getMobilizerTransform(state_).R() *
                                  vector(&u[0]));  // body axes
            for (int i = 0; i < u.size(); ++i) all.push_back(u[i]);
        }
        return all;
    }

  private:
    SimTK::MobilizedBody const& mobod(std::size_t k) const {
        return matter_.getMobilizedBody(SimTK::MobilizedBodyIndex(k + 1));
    }

    void add(Row const& row) {
        double const* const r = row.rotation;
        Rotation const turn(SimTK::Mat33(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]),
                            true);
        Transform const inboard(turn, vector(row.translation));
        double const* const j = row.inertia;
        Vec3 const com = vector(row.com);
        SimTK::Inertia const about_com(Vec3(j[0], j[1], j[2]), Vec3(j[3], j[4], j[5]));
        SimTK::Body::Rigid const body(
            SimTK::MassProperties(row.mass, com, about_com.shiftFromMassCenter(com, row.mass)));
        SimTK::MobilizedBody& last =
            matter_.updMobilizedBody(SimTK::MobilizedBodyIndex(matter_.getNumBodies() - 1));
        if (row.kind == revolute) {
            Rotation const to_z(SimTK::UnitVec3(vector(row.axis)), SimTK::ZAxis);
            SimTK::MobilizedBody::Pin(last, Transform(turn * to_z, inboard.p()), body,
                                      Transform(to_z));
        } else if (row.kind == ball) {
            SimTK::MobilizedBody::Ball(last, inboard, body, Transform());
        } else if (row.kind == slide) {
            SimTK::MobilizedBody::Translation(last, inboard, body, Transform());
        } else {
            SimTK::MobilizedBody::Universal(last, inboard, body, Transform());
        }
    }
    /// Rates of ball joints are in the inboard frame's axes here.
    void place(Row const& row, SimTK::MobilizedBody const& body) {
        if (row.kind == ball) {
            SimTK::Quaternion const q(SimTK::Vec4(row.q[0], row.q[1], row.q[2], row.q[3]));
            body.setQFromVector(state_, SimTK::Vector(q.asVec4()));
            body.setUFromVector(state_, SimTK::Vector(Rotation(q) * vector(row.qd)));
            return;
        }
        if (row.kind == revolute) body.setOneQ(state_, 0, row.q[0]);
        for (int i = 0; i < body.getNumU(state_); ++i) body.setOneU(state_, i, row.qd[i]);
    }
    void load(Row const& row, SimTK::MobilizedBody const& body) {
        Vec3 const torque = row.kind == ball
                                ? body.getMobilizerTransform(state_).R() * vector(row.torque)
                                : vector(row.torque);
        for (int i = 0; i < body.getNumU(state_); ++i)
            loads_.setOneMobilityForce(state_, body, SimTK::MobilizerUIndex(i), torque[i]);
        Vec3 const arm = body.getBodyRotation(state_) * vector(row.com),
                   force = vector(row.wrench_force);
        if (force == Vec3(0) && vector(row.wrench_torque) == Vec3(0))
            return;  // from the first one on they cost time
        loads_.setOneBodyForce(state_, body,
                               SimTK::SpatialVec(vector(row.wrench_torque) + arm % force, force));
    }

    std::vector<Row> const& rows_;
    SimTK::MultibodySystem system_;
    SimTK::SimbodyMatterSubsystem matter_;
    SimTK::GeneralForceSubsystem forces_;
    SimTK::Force::DiscreteForces loads_;
    SimTK::State state_;
};

/// Builds the chain and evaluates it once.
class Server {
  public:
    Server(char const* chain_file, char const* accelerations_file)
        : rows_(rows_of(chain_file, gravity_)) {
        double const start = seconds_now();
        chain_ = std::make_unique<Chain>(rows_, gravity_);
        chain_->evaluate();
        double const ready = seconds_now() - start;
        std::vector<double> const found = chain_->accelerations();
        std::ofstream(accelerations_file, std::ios::binary)
            .write(reinterpret_cast<char const*>(found.data()),
                   static_cast<std::streamsize>(found.size() * sizeof(double)));
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        std::cout << R"({"name": "simbody", "version": ")" << SIMBODY_VERSION
                  << R"(", "method": "realize(Acceleration) from positions on, C++",)"
                  << R"( "set_up_seconds": )" << ready << R"(, "memory_bytes": )"
                  << 1024.0 * static_cast<double>(usage.ru_maxrss) << "}" << std::endl;
    }
    double seconds_of(long evaluations) {
        double const start = seconds_now();
        for (long i = 0; i < evaluations; ++i) chain_->evaluate();
        return seconds_now() - start;
    }

  private:
    Vec3 gravity_;
    std::vector<Row> rows_;
    std::unique_ptr<Chain> chain_;
};

int serve(char const* chain_file, char const* accelerations_file) {
    std::cout.precision(17);
    auto server = std::make_unique<Server>(chain_file, accelerations_file);
    for (std::string line; std::getline(std::cin, line);) {
        if (line == "next") {
            server.reset();  // its memory goes first
            server = std::make_unique<Server>(chain_file, accelerations_file);
        } else {
            std::cout << server->seconds_of(std::stol(line)) << std::endl;
        }
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    try {
        return serve(argv[1], argv[2]);
    } catch (std::exception const& error) {
        std::string text = error.what();
        for (char& c : text)
            if (c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' ') c = ' ';
        std::cout << R"({"stops": ")" << text << "\"}" << std::endl;
        return 1;
    }
}
