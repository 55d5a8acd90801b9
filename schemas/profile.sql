-- The driving profiles of queries/profiles.toml, and those of the user.

-- lifetime: run
CREATE TABLE profile (
    profile VARCHAR NOT NULL,         -- [profile_name] the profile, also one of a user
    style INTEGER NOT NULL,           -- rank of aggressiveness, 0 = least aggressive
    pull_out_angle_rad DOUBLE,        -- beta, the angle of pulling out; NULL: the profile observed
    cut_in_angle_rad DOUBLE,          -- theta, the angle of cutting in; NULL: the profile observed
    pull_out_headroom_m DOUBLE,       -- distance from the ego's front to the VBP's rear (VBP: vehicle being passed) when pulling out starts
    cut_in_clearance_m DOUBLE,        -- distance from the VBP's front to the ego's rear when cutting in starts
    v_min_mps DOUBLE,                 -- lowest speed for which the profile is meant
    v_max_mps DOUBLE,                 -- highest speed for which the profile is meant
    selected BOOLEAN NOT NULL         -- the user selected it for this run
);
