#include "systems/water/water_wave_system.h"

#include "systems/water/water_wave_table.h"

#include <vector>

namespace limn {

void add_wave_tables(
    Query<const Water, const WaterWaves, Without<WaveTable>> bare, Commands commands) {
    bare.each(
        [&](Entity entity, const Water&, const WaterWaves&) { commands.add(entity, WaveTable{}); });
}

void age_wave_packets(Query<WaterWaves> waters, Res<const FrameTime> time) {
    waters.each([&](WaterWaves& waves) {
        for (WavePacket& packet : waves.packets) {
            packet.age += time->step;
        }
        std::erase_if(waves.packets, [](const WavePacket& packet) {
            return !(packet.age < packet.lifetime);
        });
    });
}

void fill_wave_tables(
    Query<const Water, const WaterWaves, WaveTable, Optional<const WaterDetail>> waters,
    Res<const FrameTime> time) {
    waters.each([&](const Water& water, const WaterWaves& waves, WaveTable& table,
                    const WaterDetail* detail) {
        fill_wave_table(water, waves, time->time, table);
        if (detail != nullptr && detail->split > 0) {
            snap_waves(*detail, table);
        }
    });
}

}  // namespace limn
