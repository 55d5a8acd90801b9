"""The faults that no run may take for a pass: what each is, what the program does about it, and which test holds it."""

from __future__ import annotations

from typing import Final, NamedTuple

MCAP: Final = "MCAP, bags"
TABLES: Final = "Parquet, CSV"
ALL: Final = "all"
HERE: Final = "tests/faults/test_bad_logs.py::test_a_bad_log"


class Fault(NamedTuple):
    """One fault.

    `exit_codes`: those that it may have, by format or severity; `tells`: what the message or the finding says; `shown`: the tests that
    hold it, as `file::function`.
    """

    number: int
    what: str
    formats: str
    exit_codes: tuple[int, ...]
    tells: str
    shown: tuple[str, ...]


_DAMAGED: Final = "tests/test_damaged_logs.py::test_faults"
_SALVAGE: Final = "tests/formats/mcap/test_salvage.py"
_OSI_FILE: Final = "tests/formats/osi/test_salvage.py"
_CHECKS: Final = "tests/drive/test_checks.py"
_LIMITS: Final = "tests/evaluate/test_limits.py"
_AUDIT: Final = "tests/audit/test_audit.py"
_NAMES: Final = "tests/faults/test_names.py"
_INTERRUPTED: Final = "tests/test_interrupted.py"

FAULTS: Final = (
    Fault(1, "empty file", ALL, (4,), "the file is empty", (_DAMAGED, HERE)),
    Fault(2, "error page in HTML under the name of a log", ALL, (4,), "begins b'<html>", (_DAMAGED, HERE)),
    Fault(
        3,
        "file cut off",
        ALL,
        (3, 4),
        "of MCAP, OSI files and CSV what is left is judged: cannot be read",
        (_DAMAGED, f"{_OSI_FILE}::test_wherever_a_file_is_cut_it_is_lossy_or_a_whole_one", HERE),
    ),
    Fault(4, "footer missing", MCAP, (0,), "nothing is lost", (_DAMAGED, HERE)),
    Fault(
        5,
        "end filled with zeros",
        ALL,
        (3, 4),
        "zero bytes, or a message of 0 bytes",
        (
            _DAMAGED,
            f"{_SALVAGE}::test_zero_filled_tail",
            f"{_OSI_FILE}::test_what_follows_the_last_message",
            HERE,
        ),
    ),
    Fault(
        6,
        "wrong CRC of a chunk",
        MCAP,
        (3, 4),
        "wrong CRC",
        (
            "tests/test_damaged_logs.py::test_no_verdict_over_a_lost_chunk",
            "tests/test_damaged_logs.py::test_a_judged_step_that_fails_stands",
            HERE,
        ),
    ),
    Fault(
        7,
        "flipped bit where no CRC is",
        ALL,
        (0, 4),
        "unprotected",
        (
            "tests/formats/mcap/test_reader.py::test_files_without_crcs_are_flagged",
            "tests/formats/osi/test_file.py::test_ground_truth_and_sensor_view",
            HERE,
            "tests/faults/test_parquet.py::test_checksums_of_pages_are_checked",
        ),
    ),
    Fault(
        8,
        "index that differs from the data",
        MCAP,
        (3,),
        "the index counts",
        (f"{_SALVAGE}::test_an_index_that_counts_more_messages", HERE),
    ),
    Fault(9, "wrong CRC of the index", MCAP, (0,), "the index has a wrong CRC", (_DAMAGED, HERE)),
    Fault(
        10,
        "footer that points past the end",
        MCAP,
        (0,),
        "the index has a wrong CRC",
        (f"{_SALVAGE}::test_footer_that_points_past_the_file", HERE),
    ),
    Fault(
        11,
        "two files in one",
        ALL,
        (3, 4),
        "a second ... file begins; tables and OSI files: the clock runs again",
        (_DAMAGED, HERE),
    ),
    Fault(12, "bytes behind the end", ALL, (0, 3, 4), "bytes follow, or cannot be read", (_DAMAGED, HERE)),
    Fault(
        13,
        "record of 2^60 bytes",
        "MCAP, OSI file",
        (3, 4),
        "1152921504606846976 bytes, or of an OSI file 4294967295",
        (
            _DAMAGED,
            f"{_OSI_FILE}::test_what_follows_the_last_message",
            f"{_OSI_FILE}::test_a_message_beyond_the_cap_is_not_read",
        ),
    ),
    Fault(
        14,
        "small file that unpacks to gigabytes",
        "MCAP, Parquet",
        (4,),
        "beyond 512 MiB",
        (
            _DAMAGED,
            "tests/formats/mcap/test_reader.py::test_chunk_bomb",
            "tests/faults/test_parquet.py::test_a_bomb_is_refused",
        ),
    ),
    Fault(15, "unknown compression", MCAP, (4,), "compressed by", (_DAMAGED,)),
    Fault(
        16,
        "messages in an unknown encoding",
        MCAP,
        (3, 4),
        "which is not read",
        (
            "tests/faults/test_encodings.py::test_a_topic_of_road_users_refuses_the_log",
            "tests/faults/test_encodings.py::test_another_topic_is_passed_over",
            "tests/faults/test_encodings.py::test_a_topic_may_be_chosen",
        ),
    ),
    Fault(
        17,
        "one malformed message or row",
        ALL,
        (3, 4),
        "lost_time, malformed_row or dropped_row",
        (
            f"{_SALVAGE}::test_one_malformed_message",
            f"{_OSI_FILE}::test_one_malformed_message_is_lost_alone",
            "tests/formats/foxglove/test_scene.py::test_damaged_message",
            HERE,
        ),
    ),
    Fault(
        18,
        "time that goes backwards",
        ALL,
        (0, 3),
        "clock_jump, or clock_restart",
        (
            "tests/formats/osi/test_reader.py::test_a_clock_that_goes_backwards",
            f"{_CHECKS}::test_a_clock_that_starts_again_makes_everybody_unknown_where_it_runs_twice",
            HERE,
        ),
    ),
    Fault(
        19,
        "jump of the clock, or a gap",
        ALL,
        (3,),
        "no rule is judged across",
        (f"{_CHECKS}::test_a_hole_in_the_log", "tests/test_honesty.py::test_a_hole_is_a_row_of_its_own", HERE),
    ),
    Fault(
        20,
        "one id twice in a frame",
        ALL,
        (3,),
        "duplicate_state, with the ids",
        (
            f"{_CHECKS}::test_duplicates_that_differ_make_the_actor_unknown_there",
            "tests/test_cli.py::test_data_known_to_be_bad_make_no_pass_of_a_fail",
            HERE,
        ),
    ),
    Fault(
        21,
        "NaN or infinity",
        ALL,
        (0,),
        "not_finite or no_position",
        ("tests/formats/sumo/test_fcd.py::test_an_infinite_cell_is_unknown_and_said", HERE),
    ),
    Fault(
        22,
        "another unit or frame",
        ALL,
        (4,),
        "is wrong",
        (
            f"{_CHECKS}::test_headings_in_degrees_are_refused_whatever_the_format",
            "tests/test_cli.py::test_headings_in_another_unit_are_4",
            HERE,
        ),
    ),
    Fault(
        23,
        "map that is missing or changed",
        "maps",
        (4,),
        "does not exist",
        (
            "tests/test_cli.py::test_a_mistake_is_one_line_with_the_right_exit_code",
            "tests/faults/test_results.py::test_a_map_that_is_another_now",
            "tests/formats/test_map_registry.py::test_malformed_and_truncated_xml",
        ),
    ),
    Fault(
        24,
        "drive off the map",
        "maps",
        (4,),
        "of another place, or missing_registration with the share",
        (
            "tests/test_run.py::test_a_map_of_another_place_is_refused",
            "tests/test_run.py::test_a_map_beside_the_drive_makes_map_rules_unknown_not_failed",
        ),
    ),
    Fault(
        25,
        "lane that is no polygon",
        "maps",
        (4,),
        "names the lane",
        (
            "tests/formats/commonroad/test_lanelets.py::test_a_lanelet_that_cannot_be_read_is_named",
            "tests/formats/lanelet2/test_reader.py::test_a_lane_whose_bound_has_no_points_is_left_out_and_named",
        ),
    ),
    Fault(
        26,
        "DTD in XML",
        "maps, SUMO, CommonRoad",
        (4,),
        "DOCTYPE",
        (
            "tests/formats/test_map_registry.py::test_a_doctype_is_refused",
            "tests/formats/commonroad/test_lanelets.py::test_what_cannot_be_a_map_is_refused",
        ),
    ),
    Fault(
        27,
        "topic that is not there",
        ALL,
        (0,),
        "missing_road_users and the like",
        (
            "tests/faults/test_encodings.py::test_without_road_users_nobody_is_claimed_absent",
            "tests/test_honesty.py::test_a_log_without_indicators_is_named_and_counted",
        ),
    ),
    Fault(
        28,
        "rule without end or out of memory",
        "rules",
        (2,),
        "rule_timeout, out_of_memory",
        (
            f"{_LIMITS}::test_a_rule_without_end_is_an_error_and_the_others_are_as_without_it",
            f"{_LIMITS}::test_a_pack_of_bombs_is_contained",
        ),
    ),
    Fault(
        29,
        "crash of a worker",
        "audit",
        (4,),
        "quarantined",
        (f"{_AUDIT}::test_a_drive_over_which_workers_die_is_quarantined_and_the_others_are_judged",),
    ),
    Fault(
        30,
        "disk full",
        "results",
        (75,),
        "free the disk",
        (
            "tests/result/test_files.py::test_a_full_disk_leaves_the_earlier_results_whole",
            "tests/convert/test_convert.py::test_a_full_disk_leaves_nothing_behind",
        ),
    ),
    Fault(
        31,
        "kill between a result and its receipt",
        "audit",
        (0, 1),
        "the same tables",
        (f"{_AUDIT}::test_kills_lose_nothing_and_double_nothing",),
    ),
    Fault(
        32,
        "log that changes while it is read",
        ALL,
        (4,),
        "changed",
        (
            "tests/faults/test_changes.py::test_a_log_that_changes_between_hash_and_reading",
            "tests/annotate/test_annotator.py::test_a_log_that_changes_while_it_is_judged_is_not_judged",
            "tests/formats/mcap/test_copy.py::test_a_log_that_changed_meanwhile_is_refused",
            "tests/audit/test_bucket.py::test_a_log_that_changes_between_listing_and_reading_is_refused",
        ),
    ),
    Fault(
        33,
        "object store that refuses now and then",
        "audit",
        (0, 1, 75),
        "the same tables",
        ("tests/audit/test_bucket.py::test_a_store_that_fails_now_and_then_gives_the_same_tables",),
    ),
    Fault(
        34,
        "dead scheduler or node",
        "audit",
        (75,),
        "goes on after",
        ("tests/audit/test_clusters.py::test_a_dead_scheduler_is_exit_75_and_the_audit_goes_on_after",),
    ),
    Fault(
        35,
        "two audits of one key",
        "audit",
        (0, 1),
        "one winner",
        (
            "tests/audit/test_bucket.py::test_two_writers_of_one_receipt_have_one_winner",
            "tests/audit/test_claims.py::test_each_drive_is_given_to_one_of_two",
        ),
    ),
    Fault(
        36,
        "results of several versions",
        "results",
        (2,),
        "other versions of, or output schema",
        (
            "tests/audit/test_audit.py::test_other_versions_are_refused_in_the_same_folder",
            "tests/faults/test_results.py::test_a_result_that_is_not_of_one_run",
        ),
    ),
    Fault(
        37,
        "file name with a glob's or a shell's characters",
        ALL,
        (0,),
        "exactly that file",
        (
            "tests/formats/test_files.py::test_an_existing_name_is_taken_literally",
            f"{_NAMES}::test_exactly_that_file",
            f"{_NAMES}::test_a_name_as_long_as_names_can_be_stops_nobody",
        ),
    ),
    Fault(
        38,
        "result that was cut",
        "results",
        (2,),
        "cannot be read",
        ("tests/faults/test_results.py::test_a_result_that_is_not_of_one_run",),
    ),
    Fault(
        39, "Ctrl-C", "run", (130,), "PARTIAL", (f"{_INTERRUPTED}::test_ctrl_c_leaves_a_partial_result_that_says_so",)
    ),
    Fault(
        40,
        "ids and topics with markup or SQL in them",
        ALL,
        (0, 1),
        "shown as text",
        (
            "tests/report/test_html.py::test_markup_in_names_stays_text",
            "tests/test_streams.py::test_a_hostile_file_name_and_id_is_text_on_the_terminal",
            f"{_NAMES}::test_words_of_a_log_are_text_everywhere",
        ),
    ),
)
"""Every fault once, in order."""
