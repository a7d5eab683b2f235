import pytest

from fabrication import kernel_job
from fabrication.errors import KernelError


def test_a_kernel_that_stops_without_an_answer_is_an_error_and_not_a_crash(monkeypatch, tmp_path):
    monkeypatch.setattr(kernel_job.sys, "executable", "/bin/false")
    with (
        kernel_job.kernel_job(None, (), name="none", step=tmp_path / "a.step") as finish,
        pytest.raises(KernelError, match="without an answer"),
    ):
        finish()


def test_leaving_early_ends_the_process(monkeypatch, tmp_path):
    started = []
    popen = kernel_job.subprocess.Popen
    monkeypatch.setattr(
        kernel_job.subprocess, "Popen", lambda *a, **k: started.append(popen(*a, **k)) or started[0]
    )
    with kernel_job.kernel_job(None, (), name="none", step=tmp_path / "a.step"):
        pass
    assert started[0].poll() is not None
