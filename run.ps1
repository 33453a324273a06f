# The main job on Windows: .\run.ps1 [CASE.toml] [options of `fegear run`]. uv makes the environment on first use.
$ErrorActionPreference = "Stop"
if (-not (Get-Command uv -ErrorAction SilentlyContinue)) {
    Write-Error "fegear sets itself up by uv; install it: https://docs.astral.sh/uv/getting-started/installation"
}
$case = if ($args.Count) { $args } else { @("$PSScriptRoot/cases/nasa_four_square.toml") }
$extras = uv run --project $PSScriptRoot fegear run --needs @case 2>$null
$more = if ($LASTEXITCODE -eq 0 -and $extras) { $extras.Split(",") | ForEach-Object { "--extra"; $_ } } else { @() }
uv run --project $PSScriptRoot @more fegear run @case
exit $LASTEXITCODE
