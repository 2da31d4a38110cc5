#include "explicit/total/bond_sensors.hpp"

#include "interfaces/failure.hpp"
#include "state/rebuild.hpp"
#include "state/shape_functions.hpp"

namespace strata {

namespace {

BondSensor::Entry& entry_at(BondSensor& sensor, int slot) {
  for (BondSensor::Entry& entry : sensor.entries) {
    if (entry.slot == slot) return entry;
  }
  return sensor.entries.emplace_back(BondSensor::Entry{slot, 0.0, 0.0, 0.0, 0.0});
}

// What a particle of a sample adds to its force where the nodes of its bin move.
void add_particle(const Scene& scene, const Elasticity& rock, const State& state, const BondSample::Share& share,
                  const Bin& bin, BondSensor& sensor) {
  const Particles& p = state.particles;
  const std::size_t q = share.index;
  const Gradients g = gradients_at(scene, state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q));
  for (std::size_t k = 0; k < 9; ++k) {
    const auto r = static_cast<std::size_t>(bin.record[k]);
    const Master& master = state.masters[r];
    const Vec2 by_x = stress_of(rock, g.N_x[k], g.N_y[k], 0.0, 0.0).on(share.weight);
    const Vec2 by_y = stress_of(rock, 0.0, 0.0, g.N_x[k], g.N_y[k]).on(share.weight);
    BondSensor::Entry& entry = entry_at(sensor, state.total.op->slots.of_record[r]);
    entry.xx += master.x * by_x.x(), entry.yx += master.x * by_x.y();
    entry.xy += master.y * by_y.x(), entry.yy += master.y * by_y.y();
  }
}

}  // namespace

std::vector<BondSensor> make_bond_sensors(const Scene& scene, const std::vector<Elasticity>& rocks,
                                          const State& state) {
  std::vector<BondSensor> sensors;
  const std::vector<std::size_t> bin_of = bins_of_particles(state);
  for (const BondSample& sample : state.bonds.samples) {
    BondSensor& sensor = sensors.emplace_back();
    for (const BondSample::Share& share : sample.particles) {
      const Bin& bin = state.bins[bin_of[share.index]];
      add_particle(scene, rocks[state.particles.rock[share.index]], state, share, bin, sensor);
    }
    for (const BondSample::Mass& mass : sample.inertia)
      entry_at(sensor, state.total.op->slots.of_record[static_cast<std::size_t>(mass.record)]).m += mass.m;
  }
  Bonds still = state.bonds;
  for (BondSample& sample : still.samples) sample.inertia.clear();
  find_forces(rocks, state, still);
  for (std::size_t k = 0; k < sensors.size(); ++k) sensors[k].base = still.forces[k];
  return sensors;
}

void forces_of_nodes(const State& state, std::vector<Vec2>& forces) {
  const TotalMotion& t = state.total;
  forces.clear();
  for (const BondSensor& sensor : t.bonds) {
    Vec2& force = forces.emplace_back(sensor.base);
    for (const BondSensor::Entry& e : sensor.entries) {
      const auto slot = static_cast<std::size_t>(e.slot);
      force.x() += e.xx * t.u_x[slot] + e.xy * t.u_y[slot] + e.m * t.a_x[slot];
      force.y() += e.yx * t.u_x[slot] + e.yy * t.u_y[slot] + e.m * t.a_y[slot];
    }
  }
}

}  // namespace strata
