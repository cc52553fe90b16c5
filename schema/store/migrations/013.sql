-- The jobs of the last hour by worker, without a walk over all that were ever done.
CREATE INDEX job_ended ON job(ended) WHERE state = 'done';
