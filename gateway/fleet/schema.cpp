#include "gateway/fleet/schema.hpp"

namespace kinebus::fleet {

const char* const kSchema = R"sql(
BEGIN;
SELECT pg_advisory_xact_lock(20881);
CREATE TABLE IF NOT EXISTS files(
  hash bytea PRIMARY KEY CHECK (octet_length(hash) = 32),
  text_hash bytea NOT NULL,
  text bytea NOT NULL
);
CREATE TABLE IF NOT EXISTS jobs(
  id bigserial PRIMARY KEY,
  name text NOT NULL,
  file bytea NOT NULL REFERENCES files(hash),
  kind text NOT NULL, material text NOT NULL, nozzle_mm double precision NOT NULL,
  priority int NOT NULL,
  state text NOT NULL DEFAULT 'queued' CHECK (state IN
    ('queued', 'assigned', 'started', 'complete', 'cancelled', 'refused', 'failed', 'interrupted')),
  gateway text NOT NULL DEFAULT '',
  attempt int NOT NULL DEFAULT 0,
  after_run bigint NOT NULL DEFAULT 0,
  cancel boolean NOT NULL DEFAULT false,
  begun int NOT NULL DEFAULT 0,
  words text NOT NULL DEFAULT '',
  added timestamptz NOT NULL DEFAULT now(),
  changed timestamptz NOT NULL DEFAULT now(),
  CHECK ((gateway = '') <= (state IN ('queued', 'cancelled')))
);
-- A queue from before starts were counted: what can be told of them.
DO $$ BEGIN
  IF NOT EXISTS (SELECT FROM information_schema.columns WHERE table_name = 'jobs' AND column_name = 'begun'
                   AND table_schema = current_schema()) THEN
    ALTER TABLE jobs ADD COLUMN begun int NOT NULL DEFAULT 0;
    UPDATE jobs SET begun = 1 WHERE gateway <> '' AND state NOT IN ('queued', 'assigned');
  END IF;
END $$;
CREATE UNIQUE INDEX IF NOT EXISTS one_job_a_gateway ON jobs(gateway) WHERE state IN ('assigned', 'started');
CREATE INDEX IF NOT EXISTS jobs_waiting ON jobs(priority DESC, id) WHERE state = 'queued';
CREATE INDEX IF NOT EXISTS jobs_by_state ON jobs(state);
-- What machines do now is told again by their agents: it need not outlive a crash.
CREATE UNLOGGED TABLE IF NOT EXISTS machines(
  name text PRIMARY KEY,
  kind text NOT NULL, material text NOT NULL, nozzle_mm double precision NOT NULL,
  answers boolean NOT NULL, state text NOT NULL, words text NOT NULL,
  job bigint NOT NULL, progress double precision NOT NULL,
  seen timestamptz NOT NULL
);
CREATE TABLE IF NOT EXISTS notes(
  at timestamptz NOT NULL DEFAULT now(),
  job bigint NOT NULL, gateway text NOT NULL, attempt int NOT NULL, state text NOT NULL, words text NOT NULL
);
CREATE INDEX IF NOT EXISTS notes_by_job ON notes(job);
CREATE OR REPLACE FUNCTION note_job() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
  IF TG_OP = 'INSERT' OR (NEW.state, NEW.attempt, NEW.words) IS DISTINCT FROM (OLD.state, OLD.attempt, OLD.words) THEN
    INSERT INTO notes(job, gateway, attempt, state, words)
      VALUES (NEW.id, NEW.gateway, NEW.attempt, NEW.state, NEW.words);
  END IF;
  RETURN NEW;
END $$;
DROP TRIGGER IF EXISTS note_job ON jobs;
CREATE TRIGGER note_job AFTER INSERT OR UPDATE ON jobs FOR EACH ROW EXECUTE FUNCTION note_job();
COMMIT;
)sql";

}  // namespace kinebus::fleet
