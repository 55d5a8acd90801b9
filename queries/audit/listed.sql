-- The drives of the sources, before they are compared with the receipts.
CREATE OR REPLACE TABLE _listed (
    source_id VARCHAR, log VARCHAR, size BIGINT, stamp VARCHAR, options_id VARCHAR, options VARCHAR, tags MAP(VARCHAR, VARCHAR)
)
