#!/usr/bin/env bash
# Maps recordings with hgmm-slam, no poses given, and compares the trajectories with those that
# came with the recordings.
#   scripts/slam.sh [RECORDING...]     default: livox_building rgbd_kitchen lidar16_room_sim telecom
# Imports what is below HGMM_DATA_DIR to build/slam. Any other RECORDING is a rawlog, with poses in
# a .tum beside it of the same name, if there are some. Needs a build.
# Columns: scans, ATE (rms, largest), rotation (median, largest), way, scans/s, submaps, loops,
# largest memory. For the Telecom loop, distance of the end from (4.23, -18.46, -87.7 deg), where
# direct matching of scans puts it.
set -euo pipefail
failed=0 here=$PWD
cd "$(dirname "$0")/.."
bin=$PWD/build/bin out=$PWD/build/slam
mkdir -p "$out"
recordings=("$@")
[[ ${#recordings[@]} -gt 0 ]] || recordings=(livox_building rgbd_kitchen lidar16_room_sim telecom)

import() { # NAME FORMAT FOLDER [OPTIONS...]
    [[ -f $out/$1.rawlog ]] ||
        "$bin/hgmm-import" "$2" "${HGMM_DATA_DIR:?names no folder of recordings}/$3" \
            -o "$out/$1.rawlog" --poses-out "$out/$1.tum" "${@:4}" >"$out/$1.import.log"
    log=$out/$1.rawlog poses=$out/$1.tum
}

locate() { # RECORDING: sets log and poses
    case $1 in
        livox_building)
            import "$1" pcd livox_building/scans --poses "$HGMM_DATA_DIR/livox_building/poses_tum.txt" \
                --sensor-pose 0.0417,0.0233,-0.0284,0,0,0 ;;
        rgbd_kitchen) import "$1" 7scenes rgbd_kitchen ;;
        lidar16_room_sim)
            import "$1" pcd lidar16_room_sim --poses "$HGMM_DATA_DIR/lidar16_room_sim/poses_tum.txt" ;;
        telecom)
            log='/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog'
            poses= ;;
        *) log=$(cd "$here" && realpath "$1") poses=${log%.rawlog}.tum ;;
    esac
}

for recording in "${recordings[@]}"; do
    locate "$recording"
    folder=$out/$(basename "$recording" .rawlog)
    mkdir -p "$folder"
    "$bin/hgmm-slam" "$log" -o "$folder" --restart >"$folder/log" 2>"$folder/progress" ||
        { echo "$recording failed: $(tail -n 1 "$folder/progress")"; failed=1; continue; }
    echo "$recording: $(head -n 1 "$folder/log")"
    [[ -f ${poses:-} ]] &&
        /usr/bin/python3 scripts/trajectory_error.py "$folder/trajectory.tum" "$poses" |
        awk '{ printf("  %d poses, ATE %s m (largest %s m), rotation %s deg (largest %s deg), way %s m\n", $1, $2, $3, $4, $5, $6) }'
    [[ $recording != telecom ]] || tail -n 1 "$folder/trajectory.tum" | awk '{
        yaw = atan2(2 * $8 * $7, 1 - 2 * $7 * $7) * 57.29578
        printf("  end (%.2f, %.2f, %.1f deg): off by %.2f m, %.1f deg\n", $2, $3, yaw,
               sqrt(($2 - 4.23) ^ 2 + ($3 + 18.46) ^ 2), yaw + 87.7) }'
done
exit $failed
