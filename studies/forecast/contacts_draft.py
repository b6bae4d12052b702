import sys; sys.path[:0]=['/work/wt/forecast/src','/work/wt/forecast']
import numpy as np, yaml
from pathlib import Path
from asphalt_nscd.forecasting.recipe import read_recipe
from asphalt_nscd.forecasting.film import Solid
from asphalt_nscd.forecasting.rivals import hirsch
from studies.forecast.mixes import read_pairs
from dataclasses import replace
W='/work/wt/forecast/data/forecast/'
def pairs(): return read_pairs(W+'binder_mix.csv',read_recipe(W+'recipe.yaml'))
S60,S95=Solid(60e9,.2),Solid(95e9,.17)
KB=2.5e9
def ds(E,parts,n=300):
    """parts: list of steps; a step is a list of (fraction of the step's final volume, K, G) added together."""
    E=np.asarray(E,complex); K=np.full(E.shape,KB,complex); G=3*K*E/(9*K-E)
    for step in parts:
        tot=sum(f for f,_,_ in step); 
        if tot<=0: continue
        h=-np.log(1-tot)/n
        def rate(K,G):
            dK=dG=0
            zG=G*(9*K+8*G)/(6*(K+2*G)); zK=4*G/3
            for f,Ki,Gi in step:
                dK=dK+f/tot*(Ki-K)*(K+zK)/(Ki+zK); dG=dG+f/tot*(Gi-G)*(G+zG)/(Gi+zG)
            return dK,dG
        for _ in range(n):
            a=rate(K,G); b=rate(K+h*a[0]/2,G+h*a[1]/2); K=K+h*b[0]; G=G+h*b[1]
    return K,G
def young(K,G): return 9*K*G/(3*K+G)
def comp(p,rig=.35,filler=.063e-3):
    """volumes of the mix: filler_eff etc."""
    g=p.grading; s=float(g.passing_at(filler)); agg=p.aggregate_fraction
    fill=agg*s; b=1-agg
    phi1=fill/(1-rig)/(fill+b); rest=agg*(1-s)   # of fill+b
    return phi1,rest,p.voids
def dsmix(p,E,St=S60,rig=.35,air='last'):
    f1,rest,va=comp(p,rig)
    st=(St.bulk,St.shear)
    if air=='last': parts=[[(f1,*st)],[(rest,*st)],[(va,0,0)]]
    elif air=='with': # air with stones above 2 mm
        c=float(p.grading.passing_at(2e-3)); coarse=p.aggregate_fraction*(1-c); sand=rest-coarse
        parts=[[(f1,*st)],[(sand/(1-coarse),*st)],[(coarse*(1-va),*st),(va,0,0)]]
    elif air=='all': # with all grains above filler
        parts=[[(f1,*st)],[(rest*(1-va),*st),(va,0,0)]]
    return ds(E,parts)

from scipy.special import ellipk
NR=48; LO=2e-3
def ring_matrix(edge):
    n=len(edge)-1; r=0.5*(edge[1:]+edge[:-1]); q,w=np.polynomial.legendre.leggauss(6); A=np.zeros((n,n)); t=0.5*(q+1); W=0.5*w
    for j in range(n):
        a,b=edge[j],edge[j+1]
        for i in range(n):
            if i==j:
                for s in (a,b):
                    rp=r[i]+(s-r[i])*t**3; dr=abs(s-r[i])*3*t**2*W
                    m=4*r[i]*rp/(r[i]+rp)**2; A[i,j]+=np.sum(4*rp/(r[i]+rp)*ellipk(np.minimum(m,1-1e-15))*dr)
            else:
                rp=0.5*(a+b)+0.5*(b-a)*q; dr=0.5*(b-a)*w
                m=4*r[i]*rp/(r[i]+rp)**2; A[i,j]+=np.sum(4*rp/(r[i]+rp)*ellipk(m)*dr)
    return A/np.pi
RMAX=1.0  # over R' = R/2
EDGE=np.concatenate([[0.],np.geomspace(LO,RMAX,NR)]); R_=0.5*(EDGE[1:]+EDGE[:-1]); AREA=0.5*(EDGE[1:]**2-EDGE[:-1]**2); INF=ring_matrix(EDGE)
def spot(gf_edge,kf,Es,a0=0.0):
    """Stiffness over E* R' of a pair; gf_edge (m,n) fluid shear at outer edges over E*, kf (m,n) its bulk at middles."""
    n=NR; g0=max(-a0,0.); a0=max(a0,0.); h=g0+np.maximum(EDGE[1:]**2-a0**2,0)/2; hm=g0+np.maximum(R_**2-a0**2,0)/2
    wid=np.append(R_[1:],EDGE[-1])-R_
    c=EDGE[1:]*h**3/(12*gf_edge)/wid     # (m,n)
    M=np.zeros((gf_edge.shape[0],n,n),complex); k=np.arange(n)
    M+=AREA[:,None]*INF
    M[:,k,k]+=AREA*hm/kf
    M[:,k,k]+=c; M[:,k[:-1],k[1:]]-=c[:,:-1]; M[:,k[1:],k[:-1]]-=c[:,:-1]; M[:,k[1:],k[1:]]+=c[:,:-1]
    p=np.linalg.solve(M,np.broadcast_to(AREA[:,None],(len(M),n,1)).astype(complex))[...,0]
    return 2*np.pi*(p*AREA).sum(1)
FIL=63e-6; FINEST=1e-6
def path(r,E,St,rig=.35,air=True,n_per=6,nsize=60):
    """DS along sizes: edges d (s,), K,G (s,m) of everything finer than d (binder first)."""
    g=r.grading; top=g.sieve[np.flatnonzero(g.passing>=1-1e-12)[0]]
    d=np.unique(np.concatenate([np.geomspace(FINEST,FIL,12),np.geomspace(FIL,top,nsize)]))
    P=g.passing_at(d); f63=float(g.passing_at(FIL)); low=d<=FIL
    if True: P=np.where(low, f63*np.log(d/FINEST)/np.log(FIL/FINEST), P)
    V=(1-r.voids)*r.aggregate_fraction*P; b=(1-r.voids)*(1-r.aggregate_fraction)
    Veff=np.where(low,V/(1-rig),V+0*V)  # volume incl. binder held in filler
    hold=V[low][-1]*rig/(1-rig)         # binder held
    K=np.full(E.shape,KB,complex); G=3*K*E/(9*K-E); Ks,Gs=[K],[G]
    for i in range(1,len(d)):
        if low[i]: add=(Veff[i]-Veff[i-1]); total=b+ (V[i] if False else Veff[i])
        # matrix b - held ... effective: total volume stays V+b, free binder falls
        if low[i]:
            x0=Veff[i-1]/(V[i-1]+b); x1=Veff[i]/(V[i]+b)
            U=np.log((1-x0)/(1-x1)); air_f=0.
        else:
            va=r.voids*(P[i]-P[i-1])/(1-f63) if air else 0.
            done=r.voids*(P[i-1]-f63)/(1-f63) if air else 0.
            T0=V[i-1]+b+done; x=(V[i]-V[i-1]+va)/(T0+V[i]-V[i-1]+va); U=-np.log1p(-x); air_f=va/max(V[i]-V[i-1]+va,1e-30)
        nst=max(1,int(np.ceil(U/0.02))); hstep=U/nst
        for _ in range(nst):
            def rate(q,G):
                zG=G*(9+8*G*q)/(6*(1+2*G*q)); zK=4*G/3
                return -(1-air_f)*(St.bulk*q-1)*(1+zK*q)/(St.bulk+zK)+air_f*(1/zK+q),(1-air_f)*(St.shear-G)*(G+zG)/(St.shear+zG)-air_f*G*(G+zG)/zG
            q=1/K
            a=rate(q,G); c=rate(q+hstep*a[0]/2,G+hstep*a[1]/2); q=q+hstep*c[0]; G=G+hstep*c[1]; K=1/q
        Ks.append(K); Gs.append(G)
    return d,P,np.array(Ks),np.array(Gs)
def model(r,E,St,Z=6.,rig=.35,p0=10e3,air=True,classes=8,fits=1.0,sat=True,combine='series',parts=False):
    d,P,K,G=path(r,E,St,rig,air)
    Ks,Gs=K[-1],G[-1]; Eds=young(Ks,Gs)
    Est=St.modulus/(2*(1-St.poisson**2))
    grains=(1-r.voids)*r.aggregate_fraction*(1-P[np.searchsorted(d,FIL)])
    # pressed spot
    F=p0*4*np.pi*4/(grains*Z)  # over R'^2  (R=2R')
    a0=(0.75*F/Est)**(1/3) if p0>0 else 0.
    top=d[-1]; edges=np.geomspace(FIL,top,classes+1); w=np.diff(np.interp(np.log(edges),np.log(d),P)); w=w/w.sum()
    sp=0
    for k in range(classes):
        if w[k]<=0: continue
        D=np.sqrt(edges[k]*edges[k+1]); Rp=D/4
        he=fits*np.maximum(EDGE[1:]**2-a0**2,1e-12)/2*Rp; hm=fits*np.maximum(R_**2-a0**2,1e-12)/2*Rp
        lg=np.log(d)
        def at(h,M): 
            x=np.clip(np.log(h),lg[0],min(lg[-1],np.log(D))); j=np.clip(np.searchsorted(lg,x)-1,0,len(lg)-2); t=((x-lg[j])/(lg[j+1]-lg[j]))[:,None]
            return np.exp((1-t)*np.log(M[j])+t*np.log(M[j+1])).T
        gf=at(he,G)/Est; kf=at(hm,K+4*G/3)/Est
        sp=sp+w[k]*spot(gf,kf,Est,a0)
    kn=sp*Est # over R' ; R = 2R'
    vfa=(1-r.voids)*(1-r.aggregate_fraction)/((1-r.voids)*(1-r.aggregate_fraction)+r.voids)
    dry=2*Est*a0
    if sat: kn=dry+vfa*(kn-dry)
    pref=grains*Z*kn/2/np.pi
    Kn,Gn=pref/12,pref/20
    En=young(Kn,Gn)
    if combine=='sum': out=Eds+En
    else:
        lim=young(*[x for x in limit(r,St)])
        lay=1/(1/Eds-1/lim); out=1/(1/lim+1/(lay+En))
    return (out,Eds,En) if parts else out
def limit(r,St):
    K,G=np.array([St.bulk*1.0]),np.array([St.shear*1.0]); va=r.voids; n=100; h=-np.log(1-va)/n if va>0 else 0
    for _ in range(n):
        zG=G*(9*K+8*G)/(6*(K+2*G)); zK=4*G/3
        K,G=K-h*K*(K+zK)/zK,G-h*G*(G+zG)/zG
    return K[0],G[0]
def score6(f,show=True):
    out={}
    for p in pairs():
        x=np.log(f(p)/p.measured); out[p.name]=(np.exp(np.sqrt((x.real**2).mean())),np.degrees(np.sqrt((x.imag**2).mean())),np.exp(x.real.mean()),np.degrees(x.imag.mean()))
    fac=np.exp(np.sqrt(np.mean([np.log(v[0])**2 for v in out.values()]))); ph=np.sqrt(np.mean([v[1]**2 for v in out.values()]))
    return '%.2f %.1f | '%(fac,ph)+' '.join('%s %.2f/%.1f(%.2f,%+.0f)'%((k,)+v) for k,v in out.items())
if __name__=='__main__':
    import time
    t=time.process_time()
    for name,St in (('60',S60),('95',S95)):
        for kw in (dict(),dict(air=False),dict(combine='sum'),dict(p0=1e3),dict(fits=.5),dict(sat=False),dict(Z=4)):
            print(name,kw,score6(lambda p:model(p.recipe,p.binder(),St,**kw)))
    print(time.process_time()-t)
    for p in pairs()[:4]:
        o,e,n=model(p.recipe,p.binder(),S60,parts=True)
        for k in range(0,20,3): print(p.name,'G %8.3g kPa ph %.0f'%(abs(p.binder()[k])/3e3,np.degrees(np.angle(p.binder()[k]))),'meas %6.0f %4.1f'%(abs(p.measured[k])/1e6,np.degrees(np.angle(p.measured[k]))),'model %6.0f %4.1f ds %6.0f net %6.0f %4.1f'%(abs(o[k])/1e6,np.degrees(np.angle(o[k])),abs(e[k])/1e6,abs(n[k])/1e6,np.degrees(np.angle(n[k]))))

def model2(r,E,St,Z=6.,rig=.35,p0=10e3,air=True,fits=1.0,sat=True,nsize=40,parts=False,flat=1.0,kt=0.0,start=FIL,gap=0.0,cold=True):
    g=r.grading; top=g.sieve[np.flatnonzero(g.passing>=1-1e-12)[0]]
    d=np.unique(np.concatenate([np.geomspace(FINEST,FIL,12),np.geomspace(FIL,top,nsize)]))
    P=g.passing_at(d); f63=float(g.passing_at(FIL)); low=d<=FIL
    P=np.where(low, f63*np.log(d/FINEST)/np.log(FIL/FINEST), P); lg=np.log(d)
    V=(1-r.voids)*r.aggregate_fraction*P; b=(1-r.voids)*(1-r.aggregate_fraction)
    Est=St.modulus/(2*(1-St.poisson**2)); grains=V[-1]-V[low][-1]
    F=p0*16*np.pi/(grains*Z); a0=(0.75*F/Est)**(1/3) if p0>0 else 0.
    vfa=b/(b+r.voids) if sat else 1.
    K=np.full(E.shape,KB,complex); G=3*K*E/(9*K-E); Ks,Gs=[K],[G]
    a1=0.0 if gap>0 else a0; xe=np.maximum(EDGE[1:]**2-a1**2,1e-12)/2+4*gap; xm=np.maximum(R_**2-a1**2,1e-12)/2+4*gap
    for i in range(1,len(d)):
        va=0.
        if low[i]:
            x0=V[i-1]/(1-rig)/(V[i-1]+b); x1=V[i]/(1-rig)/(V[i]+b)
            U=np.log((1-x0)/(1-x1)); air_f=0.
        else:
            va=r.voids*(P[i]-P[i-1])/(1-f63) if air else 0.
            done=r.voids*(P[i-1]-f63)/(1-f63) if air else 0.
            tot=b+done+V[i]+va; x=(V[i]-V[i-1]+va)/tot; U=-np.log1p(-x); air_f=va/max(V[i]-V[i-1]+va,1e-30)
            if U<=0: Ks.append(K); Gs.append(G); continue
            D=np.sqrt(d[i]*d[i-1]); Rp=D/4*flat; MK=np.array(Ks); MG=np.array(Gs)
            def at(h,M):
                xx=np.clip(np.log(h),lg[0],lg[i-1]); j=np.clip(np.searchsorted(lg,xx)-1,0,i-2); t=((xx-lg[j])/(lg[j+1]-lg[j]))[:,None]
                return np.exp((1-t)*np.log(M[j])+t*np.log(M[j+1])).T
            gf=at(fits*xe*Rp,MG)/Est; kf=at(fits*xm*Rp,MK+4*MG/3)/Est
            kn=spot(gf,kf,Est,0. if not gap else -4*gap)*Est*flat if gap else spot(gf,kf,Est,a0)*Est*flat; dry=2*Est*a0*flat; kn=dry+vfa*(kn if gap else kn-dry)
            pref=(V[i]-V[i-1])/tot*Z*kn/2/np.pi; cut=(1-G/St.shear)**2; cutK=np.clip(1-K.real/St.bulk,0,1)**2
            dKn,dGn=pref/12*cutK,pref/20*(1+1.5*kt)*cut
        nst=max(1,int(np.ceil(U/0.02))); hstep=U/nst
        for _ in range(nst):
            def rate(q,G):
                zG=G*(9+8*G*q)/(6*(1+2*G*q)); zK=4*G/3
                return -(1-air_f)*(St.bulk*q-1)*(1+zK*q)/(St.bulk+zK)+air_f*(1/zK+q),(1-air_f)*(St.shear-G)*(G+zG)/(St.shear+zG)-air_f*G*(G+zG)/zG
            q=1/K
            a=rate(q,G); c=rate(q+hstep*a[0]/2,G+hstep*a[1]/2); q=q+hstep*c[0]; G=G+hstep*c[1]; K=1/q
            if not low[i]: K=K+dKn/nst; G=G+dGn/nst
        Ks.append(K); Gs.append(G)
    if not air and r.voids>0:
        n=60; h=-np.log(1-r.voids)/n; q=1/K
        for _ in range(n):
            zG=G*(9+8*G*q)/(6*(1+2*G*q)); zK=4*G/3; q=q+h*(1/zK+q); G=G-h*G*(G+zG)/zG
        K=1/q
    return young(K,G)
if __name__=='__main__':
    for name,St in (('60',S60),('95',S95)):
        for kw in (dict(),dict(Z=4),dict(Z=12),dict(p0=1e3),dict(p0=1e3,Z=4),dict(p0=0.),dict(air=False),dict(fits=.5),dict(sat=False)):
            print(name,kw,score6(lambda p:model2(p.recipe,p.binder(),St,**kw)))
    for p in pairs()[:4]:
        o=model2(p.recipe,p.binder(),S60)
        for k in range(0,20,3): print(p.name,'G %8.3g kPa ph %.0f'%(abs(p.binder()[k])/3e3,np.degrees(np.angle(p.binder()[k]))),'meas %6.0f %4.1f'%(abs(p.measured[k])/1e6,np.degrees(np.angle(p.measured[k]))),'model %6.0f %4.1f'%(abs(o[k])/1e6,np.degrees(np.angle(o[k]))))

def model3(r,E,St,Z=2.,rough=0.,p=10e3,rig=.35,nsize=24,sat=True,zdry=None,n=3,skel=True,rel=0.,parts=False,air_with=FIL):
    g=r.grading; top=g.sieve[np.flatnonzero(g.passing>=1-1e-12)[0]]
    d=np.unique(np.concatenate([np.geomspace(FINEST,FIL,8),np.geomspace(FIL,top,nsize)]))
    P=g.passing_at(d); f63=float(g.passing_at(FIL)); low=d<=FIL
    P=np.where(low, f63*np.log(d/FINEST)/np.log(FIL/FINEST), P); lg=np.log(d)
    V=(1-r.voids)*r.aggregate_fraction*P; b=(1-r.voids)*(1-r.aggregate_fraction)
    Est=St.modulus/(2*(1-St.poisson**2)); grains=V[-1]-V[low][-1]
    vfa=b/(b+r.voids) if sat else 1.
    K=np.full(E.shape,KB,complex); G=3*K*E/(9*K-E); Ks,Gs=[K],[G]
    done=0.
    pw=float(g.passing_at(air_with)) if air_with>FIL else f63
    for i in range(1,len(d)):
        va=0.
        if low[i]:
            x0=V[i-1]/(1-rig)/(V[i-1]+b); x1=V[i]/(1-rig)/(V[i]+b)
            U=np.log((1-x0)/(1-x1)); air_f=0.
        else:
            va=r.voids*max(P[i]-max(P[i-1],pw),0)/(1-pw)
            tot=b+done+V[i]+va; done+=va; x=(V[i]-V[i-1]+va)/tot; U=-np.log1p(-x); air_f=va/max(V[i]-V[i-1]+va,1e-30)
            if U<=0: Ks.append(K); Gs.append(G); continue
            D=np.sqrt(d[i]*d[i-1]); Rp=D/4; MK=np.array(Ks); MG=np.array(Gs); x0=rough/Rp+4*rel
            xe=EDGE[1:]**2/2+x0; xm=R_**2/2+x0
            def at(h,M):
                xx=np.clip(np.log(h),lg[0],lg[i-1]); j=np.clip(np.searchsorted(lg,xx)-1,0,i-2); t=((xx-lg[j])/(lg[j+1]-lg[j]))[:,None]
                return np.exp((1-t)*np.log(M[j])+t*np.log(M[j+1])).T
            kn=vfa*spot(at(xe*Rp,MG)/Est,at(xm*Rp,MK+4*MG/3)/Est,Est,-x0)*Est
            pref=(V[i]-V[i-1])/tot*Z*kn/2/np.pi
            dKn,dGn=pref/12*(1-K/St.bulk)**2,pref/20*(1-G/St.shear)**2
        nst=max(1,int(np.ceil(U/0.03))); hstep=U/nst
        for _ in range(nst):
            def rate(q,G):
                zG=G*(9+8*G*q)/(6*(1+2*G*q)); zK=4*G/3
                return -(1-air_f)*(St.bulk*q-1)*(1+zK*q)/(St.bulk+zK)+air_f*(1/zK+q),(1-air_f)*(St.shear-G)*(G+zG)/(St.shear+zG)-air_f*G*(G+zG)/zG
            q=1/K
            a=rate(q,G); c=rate(q+hstep*a[0]/2,G+hstep*a[1]/2); q=q+hstep*c[0]; G=G+hstep*c[1]; K=1/q
            if not low[i]: K=K+dKn/nst; G=G+dGn/nst
        Ks.append(K); Gs.append(G)
    zd=zdry or 4.
    F=p*16*np.pi/(grains*zd); a0=(0.75*F/Est)**(1/3); kn=2*Est*a0  # per R'
    mind=2*(1-St.poisson)/(2-St.poisson)
    pref=grains*zd*kn/2/np.pi; Kd,Gd=pref/12,pref/20*(1+1.5*mind)
    if skel: K=K+Kd*(1-K/St.bulk)**2; G=G+Gd*(1-G/St.shear)**2
    return young(K,G)
if __name__=='__main__':
    import time; t=time.process_time()
    for kw in (dict(),dict(p=1e3),dict(rough=1e-6),dict(rough=3e-7),dict(rough=3e-7,Z=3),dict(rough=1e-6,Z=3),dict(rough=3e-6,Z=3),dict(rough=1e-6,Z=4),dict(rough=3e-6,Z=4),dict(rel=1e-4),dict(rel=3e-4),dict(rough=3e-7,p=1e3)):
        print(kw,score6(lambda p:model3(p.recipe,p.binder(),S60,**kw)))
        o2=model3(pairs()[0].recipe,np.array([3.,30.,300.,3e3,3e4,3e5,3e6,3e7])*np.exp(1.2j),S60,**kw)
        print('    ',np.round(abs(o2)/1e6),np.round(np.degrees(np.angle(o2)),1))
    print(time.process_time()-t)
